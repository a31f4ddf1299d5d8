"""From records of promised errors to a flat table."""

from typing import Any

import numpy as np
import pandas as pd

from analysis.records.tables import Named, place

NUMBERS = ["error_below", "promised", "delivered", "seconds", "trial_seconds", "methods", "ratio"]
COLUMNS = [
    "file", "machine", "scale", "experiment", "scene_name", "session", "particles", "threads", "measure",
    "kept", "method", "cheapest", *NUMBERS,
]  # fmt: skip


def table(records: Named) -> pd.DataFrame:
    """One row a bound that an error was to stay below: where it stands, `measure`, `error_below`, what was
    `promised` and `delivered`, NaN where no method is known to reach the bound, `kept`, `method` with its
    `seconds`, the `cheapest` of all `methods` that keep the bound, and `ratio`, how many times as much the
    chosen one costs.
    """
    rows = [
        {
            **place(name, record),
            "particles": record["scene"]["particles"],
            "threads": record["axes"]["threads"],
            **_row(row),
        }
        for name, record in records
        for row in record["promises"]
    ]
    return pd.DataFrame(rows, columns=COLUMNS).astype(dict.fromkeys(NUMBERS, float))


def _row(row: dict[str, Any]) -> dict[str, object]:
    told = {"measure": row["measure"], "error_below": row["error_below"], "kept": False}
    if row["chosen"] is None:
        return told
    chosen, cheapest = row["chosen"], row["cheapest"]
    delivered = np.nan if chosen["error"] is None else chosen["error"]
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
