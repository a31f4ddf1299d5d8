"""A claim as `claims.toml` states it, and what a test of it may look at."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from analysis.derived.noise_prior import prior
from analysis.records.published import Published
from analysis.records.studies import Study
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


def load() -> list[Claim]:
    """Read the claims; a key that is no field of `Claim` or `Origin` is an error."""
    content = tomllib.loads(CLAIMS_FILE.read_text(encoding="utf-8"))
    return [_claim(content["other_scales"], **table) for table in content["claim"]]


def _claim(reasons: Mapping[str, str], **table: Any) -> Claim:  # noqa: ANN401
    origin, scales = Origin(**table.pop("published")), tuple(table.pop("scales"))
    return Claim(published=origin, scales=scales, other_scales=reasons[table.pop("other_scales")], **table)
