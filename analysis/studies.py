"""Splits records into studies: what was measured on one machine, from one source revision, at one scale."""

from dataclasses import dataclass

import pandas as pd

from analysis.records import Records

SCALES = ["paper", "quick"]
TABLES = ["runs", "times", "trajectory", "phases", "threads", "counters"]


@dataclass(frozen=True)
class Study:
    """The tables of one machine, source revision and scale; nothing here may be merged with another study."""

    machine: str
    revision: str
    scale: str
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
    """Runs of a general engine on the machine at that scale, whatever the revision."""

    @property
    def name(self) -> str:
        """One line that tells this study from every other."""
        return f"{self.machine}, {self.scale} scale, revision {self.revision}"

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
        """Return the records of one experiment whose check passed."""
        return self.runs[(self.runs["experiment"] == experiment) & (self.runs["check_verdict"] == "passed")]


def split(records: Records) -> list[Study]:
    """Return the studies in the records, the one to show first at the front: published sizes, then most
    records.

    A series that mixes several binaries within a study is told apart by compiler, or by the binary's hash. A
    failure does not tell its machine: it belongs to every study of its scale and site.
    """
    studies = [
        Study(
            machine,
            revision,
            scale,
            **_parts(records, runs),
            failures=_failures(records, scale, runs),
            limits=records.limits[records.limits["machine"] == machine],
            outside=records.outside[
                (records.outside["machine"] == machine) & (records.outside["scale"] == scale)
            ],
        )
        for (machine, revision, scale), runs in records.runs.groupby(["machine", "revision", "scale"])
    ]
    return sorted(studies, key=lambda study: (_scale_order(study.scale), -len(study.runs)))


def _scale_order(scale: str) -> int:
    return SCALES.index(scale) if scale in SCALES else len(SCALES)


def _failures(records: Records, scale: str, runs: pd.DataFrame) -> pd.DataFrame:
    table = records.failures
    return table[(table["scale"] == scale) & table["site"].isin(runs["site"])].reset_index(drop=True)


def _parts(records: Records, runs: pd.DataFrame) -> dict[str, pd.DataFrame]:
    names, parts = _names_by_binary(runs), {}
    for name in TABLES:
        table = getattr(records, name)
        table = table[table["file"].isin(runs["file"])].reset_index(drop=True)
        keys = zip(table["experiment"], table["series"], table["binary_sha256"], strict=True)
        parts[name] = table.assign(series=[names.get(key, key[1]) for key in keys])
    return parts


def _names_by_binary(runs: pd.DataFrame) -> dict[tuple[str, str, str], str]:
    names: dict[tuple[str, str, str], str] = {}
    distinct = runs[["experiment", "series", "binary_sha256", "compiler"]].drop_duplicates()
    for (experiment, series), group in distinct.groupby(["experiment", "series"]):
        binaries = group[["binary_sha256", "compiler"]]
        if len(binaries) < 2:
            continue
        by_compiler = binaries["compiler"].is_unique
        for binary, compiler in binaries.itertuples(index=False):
            label = compiler if by_compiler else f"program {binary[:8]}"
            names[(experiment, series, binary)] = f"{series} ({label})"
    return names
