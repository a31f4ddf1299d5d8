"""The result in words, for a terminal and as Markdown."""

from collections.abc import Mapping, Sequence

from experiments.compare.answer import Answer, Difference
from experiments.compare.blocks import Runs
from experiments.compare.options import Asked
from experiments.compare.question import AGAIN
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


def result(asked: Asked, answer: Answer, runs: Mapping[str, Runs], blocks: int, seconds: float) -> list[str]:
    """The lines of the result."""
    lines = _table(
        [
            [
                f"{one.name} against {asked.reference}",
                change(one),
                "withdrawn" if answer.is_withdrawn else verdict(one, asked),
            ]
            for one in _in_order(answer.commands)
        ]
    )
    if answer.control is not None:
        lines.append(f"  {_control(asked, answer.control)}")
    lines.append(f"  {_how_long(answer, blocks, seconds)}")
    lines += _table([[name, *_resources(runs[name])] for name in _measured(asked, runs)])
    return lines


def _in_order(commands: Sequence[Difference]) -> list[Difference]:
    return sorted(commands, key=lambda one: one.ratio) if len(commands) > 1 else list(commands)


def _control(asked: Asked, control: Difference) -> str:
    said = f"control: {asked.reference} against itself {change(control)}"
    if control.differs:
        return (
            f"{said}: a difference where there is none. All verdicts are withdrawn: "
            "something on this machine favours one place in the order; `carom doctor` may say what"
        )
    return f"{said}: no difference, as it must be"


def _how_long(answer: Answer, blocks: int, seconds: float) -> str:
    if answer.is_settled:
        return f"settled after {seconds:.0f} s, {blocks} blocks"
    said = f"measured for {seconds:.0f} s, {blocks} blocks"
    if not blocks or not answer.commands:
        return f"{said}: an interval needs {answer.next} blocks"
    if answer.needed is None:
        return f"{said}: no number of blocks in sight would settle it; the difference may lie on the margin"
    more = about((answer.needed - answer.looked_at) * seconds / blocks)
    return f"{said}: {answer.needed} blocks would settle it, {more} more: `--time` gives them"


def _measured(asked: Asked, runs: Mapping[str, Runs]) -> list[str]:
    return [one.name for one in asked.commands if runs[one.name].seconds]


def _resources(runs: Runs) -> list[str]:
    told = [duration(runs.median("seconds")), f"{runs.median('cores'):.1f} cores"]
    told.append(memory(max(runs.bytes)) if runs.bytes else "memory not known")
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
    asked: Asked, answer: Answer, runs: Mapping[str, Runs], machine: str, said: Sequence[str]
) -> str:
    """The result as a table for a page or a comment: the verdict first, the machine and how last."""
    first = answer.commands[0] if answer.commands else None
    title = "nothing was settled"
    if answer.is_withdrawn:
        title = f"withdrawn: {asked.reference} differs from itself"
    elif first is not None and len(answer.commands) == 1:
        title = f"{first.name} against {asked.reference}: {verdict(first, asked)}"
    elif answer.commands:
        title = f"{len(answer.commands)} commands against {asked.reference}"
    rows = ["| command | time | change of time | verdict |", "|---|---|---|---|"]
    for name in _measured(asked, runs):
        own = next((one for one in answer.commands if one.name == name), None)
        told = (change(own), verdict(own, asked)) if own else ("", "reference")
        rows.append(f"| {_cell(name)} | {duration(runs[name].median('seconds'))} | {told[0]} | {told[1]} |")
    if answer.control is not None:
        rows.append(f"| {_cell(asked.reference + AGAIN)} | | {change(answer.control)} | control |")
    lines = "\n".join(f"    {one.strip()}" for one in said)
    commands = "\n".join(f"    {one.name}: {one.line}" for one in asked.commands)
    folded = f"<details><summary>Machine and commands</summary>\n\n    {machine}\n{commands}\n{lines}"
    return f"**{title}**\n\n" + "\n".join(rows) + f"\n\n{folded}\n\n</details>\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
