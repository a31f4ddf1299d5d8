"""What the runner wrote down of its plan, `plan.json`: how many runs each experiment is to have."""

import json
from collections.abc import Collection
from pathlib import Path

from support.vocabulary import PLAN


def planned_runs(results: Path, scale: str, experiment: str, points: Collection[str]) -> int | None:
    """Return how many runs the experiment is to have at that scale.

    None where the folder has no such plan, or where it is not the plan of these `points`, as for records that
    were collected from elsewhere.
    """
    try:
        plan = json.loads((results / PLAN).read_text(encoding="utf-8"))[scale][experiment]
        return int(plan["runs"]) if set(points) <= set(plan["points"]) else None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
