"""One claim judged on given records, for the tests of claims."""

from pathlib import Path
from typing import Any

import pandas as pd

from analysis import claims
from analysis.tests.synthetic import write

Records = list[dict[str, Any]]


def verdicts_of(folder: Path) -> pd.DataFrame:
    """Return a row a claim, by its id, of the first study in a folder."""
    return claims.evaluate(claims.evidence_of(folder)[0]).set_index("id")


def row_of(folder: Path, records: Records, claim: str) -> pd.Series:
    """Return the claim's row, of the records and of what the folder has already."""
    write(folder, records)
    return verdicts_of(folder).loc[claim]


def figures(row: pd.Series) -> dict[str, list[str]]:
    """Return the published figure and ours, by what they are of."""
    return {what: both for what, *both in row["figures"]}
