"""From records of promised errors to the rows of a flat table."""

import math
from collections.abc import Iterable
from typing import Any

from analysis.records.tables import PLACE, Record, Row, place, revision_of

NUMBERS = ["error_below", "promised", "delivered", "seconds", "trial_seconds", "methods", "ratio"]
COLUMNS = [*PLACE, "revision", "particles", "threads", "measure", "kept", "method", "cheapest", *NUMBERS]


def promises(name: str, record: Record) -> Iterable[Row]:
    """Give one row a bound that an error was to stay below: where it stands, `measure`, `error_below`, what
    was `promised` and `delivered`, NaN where no method is known to reach the bound, `kept`, `method` with its
    `seconds`, the `cheapest` of all `methods` that keep the bound, and `ratio`, how many times as much the
    chosen one costs.
    """
    return (
        {
            **place(name, record),
            "revision": revision_of(record["provenance"]),
            "particles": record["scene"]["particles"],
            "threads": record["axes"]["threads"],
            **_row(row),
        }
        for row in record["promises"]
    )


def _row(row: dict[str, Any]) -> dict[str, object]:
    told = {"measure": row["measure"], "error_below": row["error_below"], "kept": False}
    if row["chosen"] is None:
        return told
    chosen, cheapest = row["chosen"], row["cheapest"]
    delivered = math.nan if chosen["error"] is None else chosen["error"]
    return told | {
        "promised": row["promised"],
        "delivered": delivered,
        "kept": bool(delivered <= row["error_below"]),
        "method": _method(chosen),
        "seconds": chosen["seconds"],
        "trial_seconds": row["trial_seconds"],
        "cheapest": _method(cheapest),
        "methods": row["methods"],
        "ratio": chosen["seconds"] / cheapest["seconds"],
    }


def _method(delivered: dict[str, Any]) -> str:
    steps = "" if delivered["substeps"] == 1 else f", dt = 1/{delivered['substeps']}"
    return f"{delivered['variant']}{steps}"
