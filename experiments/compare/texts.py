"""The result in words, as lines for a terminal."""

import math
from collections.abc import Sequence

from experiments.compare.answer import Difference, Place
from experiments.compare.blocks import Runs
from experiments.compare.counts import counted, percent
from experiments.compare.found import Found
from experiments.compare.options import Asked
from experiments.run.progress import about, several
from support.vocabulary import WALL

_UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))

_STARTS = 0.01
"""Seconds beside which the start of a program is no longer small."""


def change(one: Difference) -> str:
    """`−6.3 % [−7.1, −5.4]`; without the ends where there is no interval yet."""
    middle = f"{percent(one.ratio - 1)} %"
    if one.low is None or one.high is None:
        return f"{middle} (too few blocks for an interval)"
    return f"{middle} [{percent(one.low - 1)}, {percent(one.high - 1)}]"


VERDICTS = {
    "faster": ("faster by more than {}", "less time, by more than {}"),
    "slower": ("slower by more than {}", "more time, by more than {}"),
    "equivalent": ("equivalent: the difference is below {}", "below {}"),
    "inconclusive": ("not settled", "not settled"),
}
"""What is known of a command, and of what a value changes."""


def verdict(one: Difference, asked: Asked, *, of_value: bool = False) -> str:
    """What is known of a difference, with the margin as a share: `2 %`."""
    is_enough = asked.one_sided and one.high is not None and one.high < 1 + asked.margin
    if one.verdict == "inconclusive" and is_enough:
        return f"not slower by more than {asked.margin * 100:g} %"
    return VERDICTS[one.verdict][of_value].format(f"{asked.margin * 100:g} %")


def duration(seconds: float) -> str:
    """A time with three digits in the unit that suits it."""
    size, unit = next(((size, unit) for size, unit in _UNITS if seconds >= size), _UNITS[-1])
    return f"{seconds / size:.3g} {unit}" if seconds < 999.5 else f"{seconds:.0f} {unit}"


def memory(amount: float) -> str:
    """Bytes, in the unit that suits them."""
    return f"{amount / 1e6:.0f} MB" if amount < 9.5e8 else f"{amount / 1e9:.2g} GB"


def result(found: Found) -> list[str]:
    """The lines of the result."""
    asked, answer = found.asked, found.answer
    lines = table([row(one, found) for one in in_order(found)])
    lines += [f"  {_control(found)}"] if answer.controls else []
    lines.append(f"  {_how_long(found)}")
    if asked.cases and not answer.commands:
        lines += table([[name, *_times(found, case)] for case, name in enumerate(asked.cases)])
    if len(answer.commands) == 1 and answer.commands[0].totals:
        lines.append(f"  {beside(answer.commands[0])}{_by_clock(found)}")
    if not asked.cases:
        measured = [one.name for one in asked.commands if found.runs[one.name, 0].seconds]
        lines += table([[name, *_resources(found.runs[name, 0])] for name in measured])
    lines += _counts(found)
    if answer.places:
        lines += ["  in the order of their times; those with a letter in common cannot be told apart:"]
        lines += table([[_place(one), one.name, one.bracket] for one in answer.places])
    lines += effects(found)
    return lines + [f"  {one}" for one in found.remarks]


def in_order(found: Found) -> list[Difference]:
    """By their times; cases as the program lists them."""
    cases = found.asked.cases
    return sorted(found.answer.commands, key=lambda one: (one.case, one.ratio) if cases else (0, one.ratio))


def row(one: Difference, found: Found) -> list[str]:
    """What is compared, by how much it differs, and the verdict; of a case its times beside that."""
    asked = found.asked
    said = "withdrawn" if found.answer.is_withdrawn else verdict(one, asked) + _by_clock(found)
    if not asked.cases:
        return [f"{one.name} against {asked.reference}", change(one), said]
    times = [duration(found.runs[name, one.case].median("seconds")) for name in (asked.reference, one.name)]
    whose = f" ({one.name})" if len(asked.commands) > 2 else ""
    return [asked.cases[one.case] + whose, " → ".join(times), change(one), said]


def _by_clock(found: Found) -> str:
    return "" if found.answer.clock == WALL else ", waiting for a processor left out"


def _times(found: Found, case: int) -> list[str]:
    """The time of a case by each command that has one."""
    of_all = ((one.name, found.runs[one.name, case]) for one in found.asked.commands)
    return [f"{name} {duration(runs.median('seconds'))}" for name, runs in of_all if runs.seconds]


def hindered(by_wall: Sequence[Difference]) -> str:
    """What a busy machine means for a result, with the differences of all time where that is not judged."""
    if not by_wall:
        return "Times are longer then, and verdicts rarer: repeat it on a quiet machine"
    return (
        f"With what the commands waited for it: {'; '.join(f'{one.name} {change(one)}' for one in by_wall)}"
    )


def effects(found: Found) -> list[str]:
    """What the values of lists change, each in the mean over the others, and what two change together beyond
    that.
    """
    told = [[one.name, change(one), verdict(one, found.asked, of_value=True)] for one in found.answer.effects]
    if not told or found.answer.is_withdrawn:
        return []
    return ["  what each value changes, and what two change together beyond what each does:", *table(told)]


def _counts(found: Found) -> list[str]:
    """What was counted of two commands, which may tell why one is faster."""
    asked = found.asked
    if asked.cases or len(asked.commands) != 2:
        return []
    [other] = [one.name for one in asked.commands if one.name != asked.reference]
    rows = counted(found.runs[asked.reference, 0], found.runs[other, 0])
    return [f"  counted of each run, {asked.reference} → {other}:", *table(rows)] if rows else []


def beside(one: Difference) -> str:
    """What all time together says, and by how much blocks differ beyond what their runs explain, and runs."""
    in_all = f"all time together: {percent((one.totals or 1.0) - 1)} %"
    if one.start is None or one.round is None:
        return in_all
    start, run = 100 * one.start, 100 * one.round
    return f"{in_all}; one block differs from the next by {start:.1f} %, one run by {run:.1f} %"


def _place(one: Place) -> str:
    return str(one.first) if one.first == one.last else f"{one.first} to {one.last}"


def _control(found: Found) -> str:
    asked, controls = found.asked, found.answer.controls
    control = max(controls, key=lambda one: (one.differs, abs(one.ratio - 1)))
    case = f", {asked.cases[control.case]}" if asked.cases and control.differs else ""
    if control.differs:
        return (
            f"control: {asked.reference} against itself{case} {change(control)}: a difference where there is "
            "none. All verdicts are withdrawn: something on this machine favours one of two equals; "
            "`carom doctor` may say what"
        )
    if asked.cases:
        return f"control: {asked.reference} against itself: no difference found in any case"
    return f"control: {asked.reference} against itself {change(control)}: no difference found"


def _how_long(found: Found) -> str:
    answer, asked = found.answer, found.asked
    earlier = f", {found.before} of them earlier" if found.before else ""
    blocks = f"{several(found.blocks, 'block')}{earlier}"
    if answer.is_enough(asked.margin, one_sided=asked.one_sided):
        return f"settled after {found.seconds:.0f} s, {blocks}"
    said = f"measured for {found.seconds:.0f} s, {blocks}"
    if not found.blocks or not answer.commands:
        more = found.seconds + max(1, answer.next - found.blocks) * found.seconds_each
        enough = max(math.ceil(1.2 * more), math.floor(asked.seconds) + 1)
        option = f", which `--time {enough}s` gives" if found.blocks else ""
        return f"{said}: an interval needs {answer.next} blocks{option}"
    if answer.needed is None:
        return f"{said}: no number of blocks in sight would settle it; the difference may lie on the margin"
    seconds = (answer.needed - answer.looked_at) * found.seconds_each
    option = f"`--time {math.ceil(found.seconds + seconds)}s`"
    return f"{said}: {answer.needed} blocks would settle it, {about(seconds)} more: {option} gives them"


def _resources(runs: Runs) -> list[str]:
    seconds = runs.median("seconds")
    # What the start of a program takes is not in its time, but in its processor time.
    told = [duration(seconds), f"{runs.median('cores'):.1f} cores" if seconds > _STARTS else ""]
    told.append(memory(max(runs.bytes)) if runs.bytes else runs.memory.partition(",")[0])
    if runs.undisturbed:
        told.append(f"never stopped: {runs.undisturbed}")
    return told


def table(rows: Sequence[Sequence[str]]) -> list[str]:
    """The rows with their columns below one another, two spaces in front."""
    columns = max((len(row) for row in rows), default=0)
    widths = [max(len(row[at]) for row in rows if at < len(row)) for at in range(columns)]
    return [
        "  " + "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=False)).rstrip()
        for row in rows
    ]
