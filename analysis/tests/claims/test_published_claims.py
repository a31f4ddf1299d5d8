"""`claims.toml` is the source of what is claimed, `published.toml` of what was measured; all else agrees."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from analysis import claims
from analysis.figures import FIGURES
from analysis.figures.sweeps import chosen_in
from analysis.records import published
from analysis.report import graphs

ROOT = Path(__file__).parents[3]
CLAIMS = claims.load()

SECONDS = re.compile(r"(\d+\.\d+) s\b(?: (?:at|on|in|for)[a-z ]* ([\d ]*\d)\b(?! GHz|[.,]\d))?")
"""A time as it is told, and at which x if that follows."""


def told() -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Each text that tells published times: where it stands, of which experiments, and the text."""
    for claim in CLAIMS:
        if claim.id != "row":  # a comparison of two other experiments, named in it
            yield f"claims.toml: {claim.id}", tuple(claim.experiments), claim.published.effect
    for graph in graphs.load():
        yield f"graphs.toml: {graph.name}", tuple(graph.questions), graph.showed


@pytest.mark.parametrize(("where", "experiments", "text"), list(told()))
def test_every_time_that_is_told_is_one_that_was_published(
    where: str, experiments: tuple[str, ...], text: str
) -> None:
    times = published.load().times
    times = times[times["experiment"].isin(experiments)]
    found = SECONDS.findall(text)
    assert found or not re.search(r"\d\.\d+ s", text)
    for said, at in found:
        digits = len(said.split(".")[1])
        points = times[times["x_name"] != "repetition"]
        own = points if not at else points[points["x"] == float(at.replace(" ", ""))]
        means = times.groupby(["experiment", "series"])["seconds"].mean()
        near = np.abs(np.concatenate([own["seconds"], means]) - float(said)) <= 0.5001 * 10.0**-digits
        assert near.any(), f"{where}: {said} s at {at or 'any x'}"


def test_the_page_and_the_start_tell_the_effect_of_the_entry() -> None:
    [effect] = [claim.published.effect for claim in CLAIMS if claim.id == "four_boxes"]
    share = effect.split(" less")[0]
    times = published.load().experiment("neighbourhood").groupby("series")["seconds"].mean()
    assert share == f"{100 * (1 - times['four'] / times['nine']):.1f} %"
    assert f"takes {share} less time" in (ROOT / "docs" / "start.md").read_text(encoding="utf-8")


def test_the_questions_name_the_claims() -> None:
    asked: dict[str, set[str]] = {}
    for path in (ROOT / "experiments" / "questions").glob("*.toml"):
        claim = tomllib.loads(path.read_text(encoding="utf-8")).get("claim")
        if claim is not None:
            asked.setdefault(claim, set()).add(path.stem)
    assert asked == {claim.id: set(claim.experiments) for claim in CLAIMS}


def test_the_choice_that_is_ringed_is_a_published_point() -> None:
    drawn = [entry.experiment for entry in FIGURES if entry.kind == "schedule"]
    assert len(drawn) == 3
    for experiment in drawn:
        found = chosen_in(experiment)
        assert found is not None
        times = published.load().experiment(experiment)
        assert ((times["series"] == found[0]) & (times["x"] == found[1])).any(), experiment


def test_each_graph_that_a_claim_is_about_is_in_the_table() -> None:
    shown = {question for graph in graphs.load() for question in graph.questions}
    measured = {name for claim in CLAIMS for name in claim.experiments} & set(
        published.load().times["experiment"]
    )
    assert measured <= shown
