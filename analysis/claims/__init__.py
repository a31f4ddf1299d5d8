"""The claims of the published study, each tested again on the records."""

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.claims import curves, machines, ratios
from analysis.claims.outcome import Outcome
from analysis.records.published import Published
from analysis.records.studies import Study

CLAIMS_FILE = Path(__file__).parent / "claims.toml"
TESTS: dict[str, Callable[..., Outcome]] = {
    "scaling": curves.scaling,
    "grows": curves.grows,
    "linear": curves.linear,
    "falls_then_rises": curves.falls_then_rises,
    "spike_then_linear": curves.spike_then_linear,
    "pair": ratios.pair,
    "fewer_resolves": ratios.fewer_resolves,
    "best_schedule": ratios.best_schedule,
    "phase_dominates": ratios.phase_dominates,
}


def load() -> list[dict[str, Any]]:
    """Read the claims: `id`, `claim`, `published`, `test` and the test's arguments."""
    return list(tomllib.loads(CLAIMS_FILE.read_text(encoding="utf-8"))["claim"])


def evaluate(study: Study, studies: Sequence[Study], published: Published) -> pd.DataFrame:
    """Return a row a claim: `id`, `claim`, `published`, `experiments`, `verdict`, `measured`, `why`.

    Everything is judged on the records of `study`, except the claim about machines, which needs all of them.
    """
    rows = []
    for claim in load():
        arguments = {
            key: value for key, value in claim.items() if key not in ("id", "claim", "published", "test")
        }
        if claim["test"] == "clock":
            outcome = machines.clock(study, studies, published, **arguments)
        else:
            outcome = TESTS[claim["test"]](study, **arguments)
        experiments = arguments.get("experiments") or [arguments["experiment"]]
        stated = {key: claim[key] for key in ("id", "claim", "published")}
        rows.append({**stated, "experiments": experiments, **asdict(outcome)})
    return pd.DataFrame(rows)
