"""What each experiment was given so far: blocks, and which points take no part in the later ones."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found, Store

PLAN = "plan.json"


@dataclass
class Given:
    """A number of blocks and, by the id of a point, the first block without it: all that was asked of it is
    settled.
    """

    blocks: int
    stopped: dict[str, int] = field(default_factory=dict)

    def includes(self, point: Point, block: int) -> bool:
        """Whether the point is part of the block."""
        return block < self.stopped.get(point.id, block + 1)


def given_before(
    store: Store, experiments: Sequence[Experiment], found: Mapping[str, Found]
) -> dict[str, Given]:
    """What an earlier session gave to the experiments that it began.

    A question that now asks for more blocks than that has changed, and is decided anew. Where a point is new,
    those that had stopped are measured on with it: what was settled was so against others.
    """
    plan = store.note(PLAN) or {}
    given = {}
    for experiment in experiments:
        kept = plan.get(experiment.points[0].scale, {}).get(experiment.name)
        minimum = experiment.question.blocks.minimum
        if kept and found[experiment.name].seconds and minimum <= kept["blocks"]:
            is_known = {point.id for point in experiment.points} <= set(kept["points"])
            stopped = dict(kept.get("stopped", {})) if is_known else {}
            given[experiment.name] = Given(int(kept["blocks"]), stopped)
    return given


def keep(store: Store, experiment: Experiment, given: Given, runs: int) -> None:
    """Write down what an experiment was given, and how many runs there are once it has that."""
    plan = store.note(PLAN) or {}
    entry = {
        "blocks": given.blocks,
        "runs": runs,
        "order_seed": experiment.order_seed,
        "points": [point.id for point in experiment.points],
        **({"stopped": given.stopped} if given.stopped else {}),
    }
    of_scale = plan.setdefault(experiment.points[0].scale, {})
    if of_scale.get(experiment.name) != entry:
        of_scale[experiment.name] = entry
        store.keep_note(PLAN, plan)
