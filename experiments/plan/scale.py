"""The two sizes of the study."""

from dataclasses import dataclass, replace

from experiments.plan.question import NamedScene, Question
from experiments.plan.scenes import Scene
from experiments.plan.series import Series
from support import vocabulary
from support.errors import InputError, not_one_of
from support.vocabulary import COUNTS


@dataclass(frozen=True)
class Scale:
    """How large the scenes are, which of a question's values are taken, and how long it all may last.

    `divisor` divides discs and area, `blocks_divisor` the least number of blocks; the budget covers the
    report too, which takes about `report_seconds`.
    """

    name: str
    divisor: int
    blocks_divisor: int
    budget_seconds: float
    report_seconds: float

    def question(self, question: Question) -> Question:
        """A question at this scale: a smaller least number of blocks leaves more to the budget.

        One that leaves no choice to the budget, such as the control, stays as it is.
        """
        asked = question.blocks
        if asked.minimum == asked.wanted:
            return question
        least = min(asked.minimum, max(1, asked.minimum // self.blocks_divisor))
        return replace(question, blocks=replace(asked, minimum=least))

    def simulated(self, question: Question) -> int:
        """How many steps of a profile are simulated at this scale, 0 for none: of small scenes none, since
        valgrind takes longer to start than all else in a profile of them.
        """
        return question.simulated if self.divisor == 1 else 0

    def scenes(self, question: Question) -> tuple[NamedScene, ...]:
        """A question's scenes at this scale."""
        kept = (one for one in question.scenes if self.divisor == 1 or not one.paper_only)
        if question.kind == COUNTS:
            return tuple(kept)  # nothing is timed: the question says itself how much is counted
        return tuple(
            # A hard case has one size only.
            replace(one, scene=one.scene.shrunk(self.divisor)) if isinstance(one.scene, Scene) else one
            for one in kept
        )

    def values(self, series: Series) -> tuple[float, ...]:
        """A series' values at this scale."""
        return series.values if self.divisor == 1 else series.quick_values


_PAPER, _QUICK = vocabulary.SCALES
SCALES = {
    _PAPER: Scale(_PAPER, divisor=1, blocks_divisor=1, budget_seconds=45 * 60, report_seconds=40.0),
    _QUICK: Scale(_QUICK, divisor=10, blocks_divisor=4, budget_seconds=150.0, report_seconds=15.0),
}


def find_scale(name: str) -> Scale:
    """The scale of that name. Raises InputError with the nearest name."""
    if name not in SCALES:
        raise InputError(f"scale: {not_one_of(name, SCALES)}")
    return SCALES[name]
