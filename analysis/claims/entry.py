"""A claim as `claims.toml` states it, and what a test of it may look at."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from analysis.derived.noise_prior import prior
from analysis.records.published import Published
from analysis.records.reading import InputError
from analysis.records.studies import SCALES, Study
from analysis.statistics.moderation import Prior

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

    `other_scales` says why records of another scale do not decide it.
    """

    id: str
    claim: str
    published: Origin
    scales: tuple[str, ...]
    other_scales: str
    test: str
    arguments: Mapping[str, Any] = field(default_factory=dict)

    @property
    def experiments(self) -> Sequence[str]:
        """The experiments on whose records the test looks."""
        names: Sequence[str] = self.arguments.get("experiments") or [self.arguments["experiment"]]
        return names


@dataclass(frozen=True)
class Evidence:
    """The study that is judged, all studies (for the claim about machines alone), and the published times."""

    study: Study
    studies: Sequence[Study]
    published: Published

    def prior(self, experiment: str) -> Prior:
        """Return what the study tells of the noise of an experiment's ratios."""
        return prior(self.study, experiment)


def load(results: Path | None = None) -> list[Claim]:
    """Read the claims that a results folder brings along, or else those of the published study.

    Raises InputError for a file that is no list of claims: a key that is no field of `Claim` or `Origin`, or
    one of them that is missing.
    """
    own = results / CLAIMS_FILE.name if results is not None else CLAIMS_FILE
    path = own if own.exists() else CLAIMS_FILE
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        reasons = content.get("other_scales", {})
        return [
            _claim(path, number, reasons, table) for number, table in enumerate(content.get("claim", []), 1)
        ]
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error


def _claim(path: Path, number: int, reasons: Mapping[str, str], table: dict[str, Any]) -> Claim:
    key = f"{path}: claim[{number}]"
    try:
        told = {"effect": "not stated", **table.pop("published", {})}
        scales, why = tuple(table.pop("scales", SCALES)), table.pop("other_scales", None)
        claim = Claim(
            published=Origin(**told), scales=scales, other_scales=reasons.get(why, why or ""), **table
        )
    except TypeError as error:
        said = str(error).partition(") ")[2] or str(error).partition("() ")[2] or str(error)
        raise InputError(f"{key}: {said}; expected id, claim, test and arguments") from error
    if not {"experiment", "experiments"} & set(claim.arguments):
        raise InputError(f"{key}.arguments.experiment: missing; expected the name of a question")
    return claim
