"""A claim as `claims.toml` states it, and what a test of it may look at."""

import re
import shlex
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.derived.comparisons import stated
from analysis.records import published, reading
from analysis.records.published import Published
from analysis.records.reading import Records
from analysis.records.studies import Study, split
from support.errors import InputError
from support.vocabulary import SCALES

CLAIMS_FILE = Path(__file__).parent / "claims.toml"


@dataclass(frozen=True)
class Origin:
    """What the study says and measured: the effect, on which scene, machine and number of threads.

    `threads` is None where a claim is about the number of threads, or does not depend on it; `threads_said`
    then says so, and else whatever the number alone does not.
    """

    effect: str
    scene: str = "not stated"
    machine: str = "not stated"
    threads: int | None = None
    threads_said: str = ""


@dataclass(frozen=True)
class Claim:
    """A claim in our words, where it comes from, on which scales it may be decided and by which test.

    On a scale of `smaller_scales` its question can be settled as well, with a verdict that speaks of that
    scale alone; `other_scales` says why records of another scale do not decide the claim itself; `questions`
    is the folder of its question, empty for a published one. `short` is the claim in few words.
    """

    id: str
    claim: str
    published: Origin
    scales: tuple[str, ...]
    other_scales: str
    test: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
    questions: str = ""
    smaller_scales: tuple[str, ...] = ()
    short: str = ""

    @property
    def name(self) -> str:
        """The claim in few words, or its id."""
        return self.short or self.id.replace("_", " ")

    @property
    def experiments(self) -> Sequence[str]:
        """The experiments on whose records the test looks."""
        return self.arguments.get("experiments") or [self.arguments["experiment"]]


@dataclass(frozen=True)
class Evidence:
    """What claims and figures look at: the study that is judged or shown, all studies of the results folder,
    the published times, and the folder.
    """

    study: Study
    studies: Sequence[Study]
    published: Published
    folder: Path

    @property
    def prefix(self) -> str:
        """What the names of the study's files begin with: nothing of the first one."""
        name = re.sub(r"[^a-z0-9]+", "-", self.study.name.lower()).strip("-")
        return "" if self.study is self.studies[0] else f"{name}-"

    def margin(self, experiment: str) -> float:
        """Return the least difference that matters, as the experiment's question states it."""
        return stated(*self.study.of(experiment, "runs")).margin

    def curves(self, experiment: str) -> tuple[pd.DataFrame, pd.DataFrame]:
        """Return the sweep as it was published, and the processes of the published variant, of which the
        claims speak, or of all if it has none.
        """
        processes = self.study.times_of(experiment)
        own = processes[processes["variant"] == "published"]
        return self.published.curve(experiment), processes if own.empty else own


def evidence_of(results: Path, records: Records | None = None) -> list[Evidence]:
    """Return what there is to look at in each study of a results folder, the one to show first at the front;
    its `records` are read if they are not given.
    """
    studies, times = split(reading.load(results) if records is None else records), published.load()
    return [Evidence(study, studies, times, results) for study in studies]


def load(results: Path | None = None) -> list[Claim]:
    """Read the claims that a results folder brings along, or else those of the published study.

    Raises InputError for a file that is no list of claims: a key that is no field of `Claim` or `Origin`, or
    one of them that is missing.
    """
    path, content = _content(results)
    return [_claim(path, number, content, table) for number, table in enumerate(content.get("claim", []), 1)]


def questions_folder(results: Path) -> str:
    """Return the folder of a results folder's questions, empty for the published. Raises as `load` does."""
    return str(_content(results)[1].get("questions", ""))


def setting(questions: str) -> str:
    """Return ` QUESTIONS=` with the folder, as `make` is given it; nothing for the published ones."""
    return f" QUESTIONS={shlex.quote(questions)}" if questions else ""


def _content(results: Path | None) -> tuple[Path, dict[str, Any]]:
    own = results / CLAIMS_FILE.name if results is not None else CLAIMS_FILE
    path = own if own.exists() else CLAIMS_FILE
    try:
        return path, tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error


def _claim(path: Path, number: int, content: Mapping[str, Any], table: dict[str, Any]) -> Claim:
    key = f"{path}: claim[{number}]"
    try:
        told = {"effect": "not stated", **table.pop("published", {})}
        scales, why = tuple(table.pop("scales", SCALES)), table.pop("other_scales", None)
        claim = Claim(
            published=Origin(**told),
            scales=scales,
            other_scales=content.get("other_scales", {}).get(why, why or ""),
            questions=content.get("questions", ""),
            smaller_scales=tuple(table.pop("smaller_scales", ())),
            **table,
        )
    except TypeError as error:
        said = str(error).partition(") ")[2] or str(error).partition("() ")[2] or str(error)
        raise InputError(f"{key}: {said}; expected id, claim, test and arguments") from error
    if not {"experiment", "experiments"} & set(claim.arguments):
        raise InputError(f"{key}.arguments.experiment: missing; expected the name of a question")
    return claim
