"""The claims in a terminal: one line each, and what there is to know of each below it."""

import textwrap
from collections.abc import Iterator
from typing import Any

import pandas as pd

from analysis.claims import missing
from analysis.claims.summary import change_in_short, first_effect, mark, published_in_short, verdict_in_short
from analysis.support.wording import listed

WIDTH = 100
"""Columns of a line."""
_NO_BREAK = str.maketrans("\u00a0", " ")


def told(name: str, table: pd.DataFrame, *, verbose: bool = False) -> Iterator[str]:
    """Yield the lines about the claims of a study with that name, of a table of `claims.evaluate`."""
    yield name
    yield "  " + ", ".join(f"{amount} {state}" for state, amount in missing.tally(table).items())
    for row in table.to_dict("records"):
        yield _line(row)
        if verbose:
            yield from _details(row)


def _line(row: dict[str, Any]) -> str:
    effect = first_effect(row)
    measured = change_in_short(effect).partition(" (")[0] if effect else ""
    line = f"{mark(row):>3} {row['id']:25} {measured:22} {verdict_in_short(row)}".translate(_NO_BREAK)
    return line if len(line) <= WIDTH else f"{line[: WIDTH - 1]}…"


def _details(row: dict[str, Any]) -> Iterator[str]:
    """Yield the claim, the study's figures beside ours, what was measured, and the reason."""
    yield from _wrapped(row["claim"])
    yield from _wrapped(f"published: {row['effect']}")
    threads = (
        f"claimed at {listed(row['claimed_threads']) or 'any'}, tested at {listed(row['tested_threads'])}"
    )
    if row["tested_threads"]:
        yield from _wrapped(f"threads: {threads}")
    for one in row["effects"]:
        yield from _wrapped(f"{one.what}: published {published_in_short(one)}, here {change_in_short(one)}")
    for what, text in (("measured", row["measured"]), ("why", row["why"])):
        if text:
            yield from _wrapped(f"{what}: {text}")
    yield ""


def _wrapped(text: str) -> list[str]:
    lines = textwrap.wrap(
        text, WIDTH, initial_indent=" " * 6, subsequent_indent=" " * 8,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip
    return [line.translate(_NO_BREAK) for line in lines]
