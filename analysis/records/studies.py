"""Splits records into studies: what was measured on one machine, from one source revision, at one scale, and
no series with two programs.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

import pandas as pd

from analysis.records.reading import MEASURED, Records, Tables
from support.vocabulary import SCALES

CHECK_FAILED = 2
"""The program's exit code when a result fails its check."""


@dataclass(frozen=True, eq=False)
class Study(Tables):
    """The tables of one machine, source revision and scale; nothing here may be merged with another study.

    `limits` are of the machine, whatever the revision and the scale. `program` are the hashes of
    its programs, where another study has others on the machine.
    """

    machine: str
    revision: str
    scale: str
    program: str

    @property
    def name(self) -> str:
        """One line that tells this study from every other."""
        program = f", program {self.program}" if self.program else ""
        return f"{self.machine}, {self.scale} scale, revision {self.revision}{program}"

    @property
    def cores(self) -> int | None:
        """Physical cores of the machine; None if it does not tell."""
        cores = self.runs["cores"].dropna()
        return int(cores.iloc[0]) if len(cores) else None

    @property
    def hardware_threads(self) -> int:
        """Hardware threads of the machine."""
        return int(self.runs["hardware_threads"].iloc[0])

    def of(self, experiment: str, *names: str) -> Iterator[pd.DataFrame]:
        """Yield the rows of one experiment in each of the tables named."""
        tables = (getattr(self, name) for name in names)
        return (table[table["experiment"] == experiment] for table in tables)

    def times_of(self, experiment: str) -> pd.DataFrame:
        """Return the timed repetitions of one experiment."""
        return self.times[self.times["experiment"] == experiment]

    def runs_of(self, experiment: str) -> pd.DataFrame:
        """Return the records of one experiment whose check did not fail."""
        return self.runs[(self.runs["experiment"] == experiment) & (self.runs["check_verdict"] != "failed")]

    def failed_checks(self, experiment: str | None = None) -> int:
        """Return how many results failed their check, in one experiment or in all: records that say so, and
        points without one for that reason.
        """
        both = (self.runs, self.failures)
        runs, failures = both if experiment is None else self.of(experiment, "runs", "failures")
        return int((runs["check_verdict"] == "failed").sum() + (failures["exit_code"] == CHECK_FAILED).sum())


def split(records: Records) -> list[Study]:
    """Return the studies in the records, the one to show first at the front: published sizes, then most
    records.

    Where a series was measured with several programs, each makes a study of its own. A failure belongs to the
    studies of its scale, machine and program; one that does not tell its machine to those of its site, one
    whose program left no record to all of its machine.
    """
    keys = ["machine", "revision", "scale"]
    studies = [
        Study(
            **dict(zip(keys, key, strict=True)),
            program=program,
            **{name: _part(getattr(records, name), file=runs["file"]) for name in MEASURED},
            failures=_failures(records, key[0], key[2], runs),
            limits=_part(records.limits, machine=key[:1]),
        )
        for key, alike in records.runs.groupby(keys)
        for program, runs in _by_program(alike)
    ]
    order = {scale: place for place, scale in enumerate(SCALES)}
    return sorted(studies, key=lambda study: (order.get(study.scale, len(SCALES)), -len(study.runs)))


def _by_program(runs: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    """Split runs so that no series has two programs: of each series the program with the most runs of all
    first. Each part with the names of its programs; without, if there is one part.
    """
    programs = runs["binary_sha256"]
    order = programs.map(programs.value_counts().sort_index().rank(method="first", ascending=False))
    rank = order.groupby([runs["experiment"], runs["series"]]).rank("dense")
    parts = [runs[rank == number] for number in sorted(rank.unique())]
    if len(parts) == 1:
        return [("", runs)]
    return [(", ".join(sorted(part["binary_sha256"].str[:8].unique())), part) for part in parts]


def _failures(records: Records, machine: str, scale: str, runs: pd.DataFrame) -> pd.DataFrame:
    table = records.failures[records.failures["scale"] == scale]
    owner, program = table["owner"], table["program_sha256"]
    here = (owner == machine.partition(": ")[0]) | (owner.isna() & table["site"].isin(runs["site"]))
    alike = _part(records.runs, machine=[machine], scale=[scale])
    nowhere = program.isna() | ~program.isin(alike["binary_sha256"])
    return table[here & (nowhere | program.isin(runs["binary_sha256"]))].reset_index(drop=True)


def _part(table: pd.DataFrame, **values: Collection[str]) -> pd.DataFrame:
    """Return the rows whose columns have one of these values each."""
    for column, chosen in values.items():
        table = table[table[column].isin(chosen)]
    return table.reset_index(drop=True)
