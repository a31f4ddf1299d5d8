"""Why a command takes another time: what was counted of its runs, beside that of the reference."""

import statistics
from collections.abc import Sequence

from experiments.compare.blocks import Runs

_SHOWN = {
    "instructions": "instructions",
    "cycles": "cycles",
    "cache_misses": "cache misses",
    "branch_misses": "branches guessed wrong",
    "minor_page_faults": "page faults",
    "major_page_faults": "page faults from disk",
    "voluntary_context_switches": "waits (voluntary context switches)",
    "involuntary_context_switches": "interruptions (involuntary context switches)",
}
"""What is counted, in words, in the order in which it is told."""

_FEW = 10
"""Below so many in both, a count tells nothing."""


def counted(reference: Runs, other: Runs) -> list[list[str]]:
    """A row for each count that both have: its name, that of the reference and of the other command, and by
    how much it differs in the middle of all blocks, with the least and the greatest.
    """
    rows = []
    for name, words in _SHOWN.items():
        pairs = list(zip(reference.counts.get(name, ()), other.counts.get(name, ()), strict=False))
        if pairs and max(max(pair) for pair in pairs) >= _FEW:
            first, second = (statistics.median(side) for side in zip(*pairs, strict=True))
            rows.append([words, f"{_amount(first)} → {_amount(second)}", _change(pairs)])
    return rows


def _change(pairs: Sequence[tuple[float, float]]) -> str:
    """The middle of the changes in per cent, and how far they reach."""
    if any(first <= 0 for first, _ in pairs):
        return ""
    changes = sorted(second / first - 1 for first, second in pairs)
    middle, least, most = map(percent, (statistics.median(changes), changes[0], changes[-1]))
    return f"{middle} % ({least} to {most})"


def percent(fraction: float) -> str:
    """A fraction as a signed percentage without its sign of per cent."""
    return f"{fraction * 100:+.1f}".replace("-", "−")


def _amount(number: float) -> str:
    for size, unit in ((1e9, " G"), (1e6, " M"), (1e4, " k")):
        if number >= size:
            scale = 1e3 if unit == " k" else size
            return f"{number / scale:.3g}{unit}"
    return f"{number:.0f}"
