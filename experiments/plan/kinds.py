"""The kinds of questions: what is measured of each point, how that is judged, and how it can be drawn."""

from dataclasses import dataclass
from pathlib import Path

from support.errors import InputError
from support.vocabulary import COUNTS

_OF_TIMES = ("comparison", "trend", "scaling", "schedule")


@dataclass(frozen=True)
class Kind:
    """What is `measured`, how it is `judged`, and the `figures` that can draw it, the usual one first.

    `errors`: the question has to ask for errors; `sweep`: it has to sweep that; `scenes`: it may have
    several.
    """

    measured: str
    judged: str
    figures: tuple[str, ...]
    errors: bool = False
    sweep: str | None = None
    scenes: bool = False


_EACH = "each difference from the reference has a verdict"
_LARGE = "how the time changes over the sweep; small differences have no verdict"

KINDS = {
    "comparison": Kind("times", _EACH, _OF_TIMES),
    "control": Kind("times of the same under two labels", _EACH, ("control", "comparison")),
    "trend": Kind("times", _LARGE, ("trend", *(one for one in _OF_TIMES if one != "trend"))),
    "scaling": Kind(
        "times", _LARGE, ("scaling", *(one for one in _OF_TIMES if one != "scaling")), scenes=True
    ),
    "schedule": Kind("times", "whether one choice is the best", ("schedule", "trend", "comparison")),
    "machine": Kind("times on each machine", _LARGE, ("machine",)),
    "ladder": Kind("times", "each series against the one before", ("ladder", "comparison"), scenes=True),
    "ways": Kind("times by turns and apart", "how far the two are apart", ("ways",), scenes=True),
    "pauses": Kind("times with and without pauses", "how far the two are apart", ("pauses",)),
    "phases": Kind("the phases of a step, and a timeline", "which takes most", ("phases",)),
    "limits": Kind(
        "the phases of a step, and what the machine can do", "how near they are", ("limits",), scenes=True
    ),
    "speed_against_error": Kind(
        "times and errors", "what is cheapest for an error", ("speed_against_error",),
        errors=True, sweep="substeps", scenes=True,
    ),
    "hard_cases": Kind(
        "times and errors", "each against what it is held to", ("hard_cases",), errors=True, scenes=True
    ),
    COUNTS: Kind("work, once each", "a ratio of counts, by the claim about it", ("comparison",)),
}  # fmt: skip
"""By the name that a question and its records give."""


def kind_and_figure(file: Path, kind: str | None, figure: str | None) -> tuple[str, str]:
    """The kind of a question and its figure, of which a file may leave out either: a figure alone stands for
    the kind of its name. Raises InputError for neither, and for a figure that cannot draw the kind.
    """
    name = kind or figure
    if name is None:
        raise InputError(f"{file}: kind: missing; expected one of {', '.join(KINDS)}")
    drawn, can = figure or KINDS[name].figures[0], KINDS[name].figures
    if drawn not in can:
        raise InputError(f"{file}: figure: found {drawn} for kind {name}, expected one of {', '.join(can)}")
    return name, drawn
