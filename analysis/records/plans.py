"""What the runner wrote down of its plan, `plan.json`: how many runs each experiment is to have."""

import json
from collections.abc import Collection
from pathlib import Path

PLAN = "plan.json"


def planned_runs(results: Path, scale: str, experiment: str, points: Collection[str]) -> int | None:
    """Return how many runs the experiment is to have at that scale: of each of its points the blocks that it
    was given.

    None where the folder has no such plan, or where it is not the plan of these `points`, as for records that
    were collected from elsewhere.
    """
    try:
        plan = json.loads((results / PLAN).read_text(encoding="utf-8"))[scale][experiment]
        blocks, stopped = int(plan["blocks"]), dict(plan.get("stopped", {}))
        if not set(points) <= set(plan["points"]):
            return None
        return sum(min(blocks, int(stopped.get(point, blocks))) for point in plan["points"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
