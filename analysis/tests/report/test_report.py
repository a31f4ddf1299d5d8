import re
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from analysis import claims
from analysis.claims.entry import Evidence
from analysis.records.reading import load
from analysis.report.provenance import commands, in_the_clock
from analysis.support.wording import number, share
from analysis.tests.figures.test_figures import DRAWN
from analysis.tests.synthetic import Machine, failure, write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import page_of, study


class Page(HTMLParser):
    """Collects identifiers, local links and everything that a page would fetch."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: set[str] = set()
        self.fetched: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        if "id" in values:
            self.ids.append(values["id"])
        target = values.get("href", values.get("xlink:href", ""))
        if target.startswith("#"):
            self.links.add(target[1:])
        elif target:
            self.fetched.append(target)
        if "src" in values or tag in ("script", "link", "iframe"):
            self.fetched.append(tag)


def text_of(page: str) -> str:
    without_figures = re.sub(r"<svg.*?</svg>", "", page, flags=re.DOTALL)
    return " ".join(re.sub(r"<[^>]+>", " ", without_figures).replace("&#39;", "'").split())


def test_the_commands_measure_what_the_records_hold(tmp_path: Path) -> None:
    write(tmp_path, study(["speed_against_error", "phases"], blocks=2))
    found = {name: commands(runs) for name, runs in load(tmp_path).runs.groupby("experiment")}
    assert all(" --errors --record " in command for command in found["speed_against_error"])
    assert all(command.endswith("--warm-up 1") for command in found["phases"])


def test_it_holds_every_claim_every_figure_and_its_caption(page: str) -> None:
    text = text_of(page)
    for claim in claims.load():
        assert claim.claim in text
        assert claim.published.effect in text
    parsed = Page(page)
    for entry in DRAWN:
        assert entry.name in parsed.ids
    # Beside them the figure of all claims, wide and narrow.
    assert page.count("<svg") == len(DRAWN) + 2
    assert page.count("<figcaption>") == len(DRAWN) + 1


def test_it_needs_nothing_but_itself(page: str) -> None:
    parsed = Page(page)
    assert parsed.fetched == []
    assert parsed.links <= set(parsed.ids)
    assert len(parsed.ids) == len(set(parsed.ids))
    assert "url(http" not in page
    assert "@import" not in page


def test_it_says_machine_control_noise_gaps_failures_and_commands(page: str) -> None:
    text = text_of(page)
    for said in (
        "Example CPU @ 2.50GHz",
        "The control came out equivalent",
        "Blocks for equivalence",
        "virtual machine without a PMU",
        "run on bare metal",
        "step 3: discs 1 and 2 are still colliding",
        "make experiments SCALE=paper",
        "build/clang/carom bench scene.in --variant published",
        "OMP_PROC_BIND=close",
    ):
        assert said in text


Records = list[dict[str, Any]]


def control(blocks: int, pace: Callable[[int, bool], float]) -> Records:
    """Records of the control, each times its pace, by its block and whether it is the second one."""
    records = study(["control"], blocks=blocks, noise=QUIET)
    for record in records:
        again = record["tags"]["label"] == "A-again"
        record["repetitions"][0]["steps_seconds"] *= pace(record["tags"]["block"], again)
    return records


def two_sessions() -> Records:
    records = study(["control", "threads"], blocks=6, noise=QUIET)
    for record in records:
        if record["tags"]["experiment"] == "threads":
            record["tags"]["session"] = "another"
    return [*records, failure("threads", "checkered", "step 3: discs 1 and 2 are still colliding")]


SAID: list[tuple[Callable[[], Records], list[str]]] = [
    (list, ["There are no records yet"]),
    (two_sessions, ["measured under two labels over 1 of 2 sessions", "1 result failed the program's own"]),
    (lambda: control(6, lambda _, again: 1.1 if again else 1.0), ["The control FAILED"]),
    (lambda: control(21, lambda _, again: 1.01 if again else 1.0), ["The control is off: ", "leaves out 0"]),
    (lambda: control(8, lambda block, _: 2.3 if block in (2, 3, 6) else 1.0),
     ["The machine has two speeds, a factor of 2.3 apart: 6 of the 16 runs", "it changed 4 times between"]),
]  # fmt: skip


@pytest.mark.parametrize(("made", "said"), SAID)
def test_it_says_what_came_of_the_control_and_the_checks(
    tmp_path: Path, made: Callable[[], Records], said: list[str]
) -> None:
    write(tmp_path, made())
    text = text_of(page_of(tmp_path)).replace("\u00a0", " ")
    assert all(one in text for one in said)


def test_records_without_a_partner_are_named_where_they_are_compared_and_why(tmp_path: Path) -> None:
    """Of six blocks half have a side that was measured again later, as after an edit."""
    records = study(["neighbourhood"], blocks=6, noise=QUIET)
    again = [one for one in records if one["tags"]["series"] == "nine" and one["tags"]["block"] < 3]
    for record in again:
        record["tags"]["session"] = "later"
        record["repetitions"][0]["steps_seconds"] *= 2
    write(tmp_path, records)
    said = text_of(page_of(tmp_path)).replace("\u00a0", " ")
    assert len(again) == 3
    assert "In no ratio: 3 of four, 3 of nine, beside which their session measured nothing" in said
    assert "count in times alone: 3 of four, 3 of nine (neighbourhood). A partner is lost where" in said
    assert "from 3 blocks" in said
    write(tmp_path / "whole", study(["neighbourhood"], blocks=6, noise=QUIET))
    assert "no ratio" not in text_of(page_of(tmp_path / "whole"))


@pytest.mark.parametrize("own", [False, True])
def test_several_machines_have_a_part_each(tmp_path: Path, own: bool) -> None:
    """Also in a folder of questions without a claim."""
    if own:
        (tmp_path / "claims.toml").write_text("")
    for host in ("bench-1", "bench-2"):
        write(tmp_path, study(["machine"], blocks=1, noise=QUIET, machine=Machine(host=host)))
    page = page_of(tmp_path)
    parsed = Page(page)
    assert {"study-1", "study-2"} <= set(parsed.ids)
    assert len(parsed.ids) == len(set(parsed.ids))
    assert ("no records yet" in text_of(page)) != own
    against = "Against bench-1: Example CPU @ 2.50GHz (not interleaved, so unpaired): bench-2: Example CPU"
    assert against in text_of(page), "the figure has both"


def test_text_from_records_is_escaped(tmp_path: Path) -> None:
    write(tmp_path, study(["machine"], blocks=2, machine=Machine(cpu_model="<script>alert(1)</script>")))
    assert "<script>" not in re.sub(r"<svg.*?</svg>", "", page_of(tmp_path), flags=re.DOTALL)


def test_it_says_which_part_of_the_time_was_in_the_clock(data: Evidence) -> None:
    compared = data.study.times[data.study.times["question_kind"] != "counts"]
    assert in_the_clock(data.study).startswith(f"{number(compared['steps_seconds'].sum())} s of ")
    one = replace(data.study, times=data.study.times.iloc[:1], runs=data.study.runs.iloc[:2])
    moved = one.runs.assign(recorded_at=["2026-01-01T00:00:00Z", "2026-01-01T01:00:00Z"], session="s")
    timed = float(one.times["steps_seconds"].iloc[0])
    said = f"{number(timed)} s of {number(3600.0)} s ({share(timed / 3600)}); processes "
    assert in_the_clock(replace(one, runs=moved)).startswith(said)
