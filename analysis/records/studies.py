"""Splits records into studies: what was measured on one machine, from one source revision, at one scale, and
no series with two programs.
"""

from dataclasses import dataclass

import pandas as pd

from analysis.records.reading import Records

SCALES = ["paper", "quick"]
TABLES = ["runs", "times", "trajectory", "phases", "threads", "counters"]

CHECK_FAILED = 2
"""The program's exit code when a result fails its check."""


@dataclass(frozen=True, eq=False)
class Study:
    """The tables of one machine, source revision and scale; nothing here may be merged with another study."""

    machine: str
    revision: str
    scale: str
    program: str
    """The hashes of its programs, where another study has others on the same machine."""
    runs: pd.DataFrame
    times: pd.DataFrame
    trajectory: pd.DataFrame
    phases: pd.DataFrame
    threads: pd.DataFrame
    counters: pd.DataFrame
    failures: pd.DataFrame
    limits: pd.DataFrame
    """What the machine can do at most, whatever the revision and the scale."""
    outside: pd.DataFrame
    promises: pd.DataFrame
    """Runs of a general engine on the machine at that scale, whatever the revision."""

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
        tables = (
            table if experiment is None else table[table["experiment"] == experiment]
            for table in (self.runs, self.failures)
        )
        runs, failures = tables
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
            machine,
            revision,
            scale,
            program,
            **_parts(records, runs),
            failures=_failures(records, machine, scale, runs),
            limits=records.limits[records.limits["machine"] == machine],
            outside=records.outside[
                (records.outside["machine"] == machine) & (records.outside["scale"] == scale)
            ],
            promises=records.promises[
                (records.promises["machine"] == machine) & (records.promises["scale"] == scale)
            ],
        )
        for (machine, revision, scale), alike in records.runs.groupby(keys)
        for program, runs in _by_program(alike)
    ]
    return sorted(studies, key=lambda study: (_scale_order(study.scale), -len(study.runs)))


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


def _scale_order(scale: str) -> int:
    return SCALES.index(scale) if scale in SCALES else len(SCALES)


def _failures(records: Records, machine: str, scale: str, runs: pd.DataFrame) -> pd.DataFrame:
    table = records.failures[records.failures["scale"] == scale]
    owner, program = table["owner"], table["program_sha256"]
    here = (owner == machine.partition(": ")[0]) | (owner.isna() & table["site"].isin(runs["site"]))
    alike = records.runs[(records.runs["machine"] == machine) & (records.runs["scale"] == scale)]
    nowhere = program.isna() | ~program.isin(alike["binary_sha256"])
    return table[here & (nowhere | program.isin(runs["binary_sha256"]))].reset_index(drop=True)


def _parts(records: Records, runs: pd.DataFrame) -> dict[str, pd.DataFrame]:
    tables = {name: getattr(records, name) for name in TABLES}
    return {
        name: table[table["file"].isin(runs["file"])].reset_index(drop=True) for name, table in tables.items()
    }
