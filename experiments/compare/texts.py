"""The result in words, for a terminal and as Markdown."""

from collections.abc import Mapping, Sequence

from experiments.compare.answer import Answer, Difference, Place
from experiments.compare.blocks import Key, Runs
from experiments.compare.options import Asked
from experiments.run.progress import about

_UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))


def percent(fraction: float, digits: int = 1) -> str:
    """A fraction as a signed percentage without its sign of per cent."""
    return f"{fraction * 100:+.{digits}f}".replace("-", "−")


def change(one: Difference) -> str:
    """`−6.3 % [−7.1, −5.4]`; without the ends where there is no interval yet."""
    middle = f"{percent(one.ratio - 1)} %"
    if one.low is None or one.high is None:
        return f"{middle} (too few blocks for an interval)"
    return f"{middle} [{percent(one.low - 1)}, {percent(one.high - 1)}]"


def margin_said(asked: Asked) -> str:
    """The margin as a share: `2 %`."""
    return f"{asked.margin * 100:g} %"


def verdict(one: Difference, asked: Asked) -> str:
    """What is known of a difference."""
    return {
        "faster": f"faster by more than {margin_said(asked)}",
        "slower": f"slower by more than {margin_said(asked)}",
        "equivalent": f"equivalent: the difference is below {margin_said(asked)}",
        "inconclusive": "not settled",
    }[one.verdict]


def duration(seconds: float) -> str:
    """A time with three digits in the unit that suits it."""
    size, unit = next(((size, unit) for size, unit in _UNITS if seconds >= size), _UNITS[-1])
    return f"{seconds / size:.3g} {unit}"


def memory(amount: float) -> str:
    """Bytes, in the unit that suits them."""
    return f"{amount / 1e6:.0f} MB" if amount < 9.5e8 else f"{amount / 1e9:.2g} GB"


def result(asked: Asked, answer: Answer, runs: Mapping[Key, Runs], blocks: int, seconds: float) -> list[str]:
    """The lines of the result."""
    lines = _table([_row(one, asked, answer, runs) for one in _in_order(answer.commands, asked)])
    lines += [f"  {_control(asked, answer)}"] if answer.controls else []
    lines.append(f"  {_how_long(asked, answer, blocks, seconds)}")
    if asked.cases:
        return lines
    measured = [one.name for one in asked.commands if runs[one.name, 0].seconds]
    lines += _table([[name, *_resources(runs[name, 0])] for name in measured])
    if answer.places:
        lines += ["  in the order of their times; those with a letter in common cannot be told apart:"]
        lines += _table([[_place(one), one.name, one.bracket] for one in answer.places])
    return lines


def _in_order(commands: Sequence[Difference], asked: Asked) -> list[Difference]:
    """By their times; cases as the program lists them."""
    return sorted(commands, key=lambda one: (one.case, one.ratio) if asked.cases else (0, one.ratio))


def _row(one: Difference, asked: Asked, answer: Answer, runs: Mapping[Key, Runs]) -> list[str]:
    said = "withdrawn" if answer.is_withdrawn else verdict(one, asked)
    if not asked.cases:
        return [f"{one.name} against {asked.reference}", change(one), said]
    times = [duration(runs[name, one.case].median("seconds")) for name in (asked.reference, one.name)]
    whose = f" ({one.name})" if len(asked.commands) > 2 else ""
    return [asked.cases[one.case] + whose, " → ".join(times), change(one), said]


def _place(one: Place) -> str:
    return str(one.first) if one.first == one.last else f"{one.first} to {one.last}"


def _control(asked: Asked, answer: Answer) -> str:
    control = max(answer.controls, key=lambda one: (one.differs, abs(one.ratio - 1)))
    case = f", {asked.cases[control.case]}" if asked.cases and control.differs else ""
    if control.differs:
        return (
            f"control: {asked.reference} against itself{case} {change(control)}: a difference where there is "
            "none. All verdicts are withdrawn: something on this machine favours one of two equals; "
            "`carom doctor` may say what"
        )
    if asked.cases:
        return f"control: {asked.reference} against itself: no difference in any case, as it must be"
    return f"control: {asked.reference} against itself {change(control)}: no difference, as it must be"


def _how_long(asked: Asked, answer: Answer, blocks: int, seconds: float) -> str:
    if answer.is_enough(asked.margin, one_sided=asked.one_sided):
        return f"settled after {seconds:.0f} s, {blocks_said(blocks)}"
    said = f"measured for {seconds:.0f} s, {blocks_said(blocks)}"
    if not blocks or not answer.commands:
        return f"{said}: an interval needs {answer.next} blocks"
    if answer.needed is None:
        return f"{said}: no number of blocks in sight would settle it; the difference may lie on the margin"
    more = about((answer.needed - answer.looked_at) * seconds / blocks)
    return f"{said}: {answer.needed} blocks would settle it, {more} more: `--time` gives them"


def blocks_said(number: int) -> str:
    """So many blocks."""
    return f"{number} block{'' if number == 1 else 's'}"


def _resources(runs: Runs) -> list[str]:
    told = [duration(runs.median("seconds")), f"{runs.median('cores'):.1f} cores"]
    told.append(memory(max(runs.bytes)) if runs.bytes else runs.memory.partition(",")[0])
    if runs.undisturbed:
        told.append(f"never stopped: {runs.undisturbed}")
    return told


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    """The rows with their columns below one another, two spaces in front."""
    columns = max((len(row) for row in rows), default=0)
    widths = [max(len(row[at]) for row in rows if at < len(row)) for at in range(columns)]
    return [
        "  " + "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=False)).rstrip()
        for row in rows
    ]


def markdown(
    asked: Asked, answer: Answer, runs: Mapping[Key, Runs], machine: str, said: Sequence[str]
) -> str:
    """The result as a table for a page or a comment: the verdict first, the machine and how last."""
    rows = [_row(one, asked, answer, runs) for one in _in_order(answer.commands, asked)]
    columns = (
        ["case", "time", "change of time", "verdict"] if asked.cases else ["", "change of time", "verdict"]
    )
    table = [columns, ["---"] * len(columns), *([_cell(one) for one in row] for row in rows)]
    lines = "\n".join(f"| {' | '.join(row)} |" for row in table)
    commands = "\n".join(f"    {one.name}: {one.line}" for one in asked.commands)
    told = "\n".join(f"    {one.strip()}" for one in said)
    folded = (
        f"<details><summary>Machine and commands</summary>\n\n    {machine}\n{commands}\n{told}\n\n</details>"
    )
    return f"**{_title(asked, answer)}**\n\n{lines}\n\n{folded}\n"


def _title(asked: Asked, answer: Answer) -> str:
    if answer.is_withdrawn:
        return f"withdrawn: {asked.reference} differs from itself"
    if len(answer.commands) == 1:
        [one] = answer.commands
        return f"{one.name} against {asked.reference}: {verdict(one, asked)}"
    number = sum(one.is_settled for one in answer.commands)
    return f"{number} of {len(answer.commands)} comparisons with {asked.reference} are settled"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
