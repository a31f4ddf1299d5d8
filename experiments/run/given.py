"""How many blocks each experiment was given so far."""

from collections.abc import Mapping, Sequence

from experiments.plan.plan import Experiment
from experiments.results.store import Found, Store
from support.vocabulary import PLAN


def given_before(
    store: Store, experiments: Sequence[Experiment], found: Mapping[str, Found]
) -> dict[str, int]:
    """The blocks that an earlier session gave to the experiments that it began.

    A question that now asks for more blocks than that has changed, and is decided anew.
    """
    plan = store.note(PLAN) or {}
    given = {}
    for experiment in experiments:
        kept = plan.get(experiment.points[0].scale, {}).get(experiment.name)
        minimum = experiment.question.blocks.minimum
        if kept and found[experiment.name].seconds and minimum <= kept["blocks"]:
            given[experiment.name] = int(kept["blocks"])
    return given


def keep(store: Store, experiment: Experiment, given: int, runs: int) -> None:
    """Write down what an experiment was given, and how many runs there are once it has that."""
    plan = store.note(PLAN) or {}
    entry = {
        "blocks": given,
        "runs": runs,
        "order_seed": experiment.order_seed,
        "points": [point.id for point in experiment.points],
    }
    of_scale = plan.setdefault(experiment.points[0].scale, {})
    if of_scale.get(experiment.name) != entry:
        of_scale[experiment.name] = entry
        store.keep_note(PLAN, plan)
