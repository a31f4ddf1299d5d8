"""Where the records come from, as tables for the report: machine, checks, missing counters, commands."""

import shlex
from typing import Any

import pandas as pd

from analysis.claims.entry import setting
from analysis.figures import titles
from analysis.figures.captions import by_series
from analysis.records.reading import Records
from analysis.records.studies import Study
from analysis.report.words import tell
from analysis.statistics.pairs import runs_of, timed_runs, without_partner
from analysis.support.wording import exact, number, share
from support.vocabulary import CONTROL, COUNTS

UNTOLD = "not told by the system"
FACTS = {
    "Hosts": "node", "CPU": "cpu_model", "Cores": "cores", "CPUs usable": "affinity",
    "Virtual machine": "virtualised", "Clock governor": "governor", "Memory": "memory_bytes",
    "Operating system": "operating_system", "OpenMP": "openmp", "OpenMP settings": "environment",
    "Compilers": "compiler", "Compiler flags": "compiler_flags", "Build": "build_type",
}  # fmt: skip
"""What is told of the machine and the programs, in this order, from which columns."""


def machine(study: Study) -> list[tuple[str, str]]:
    """Return what is known of the machine and the programs, as names and (all) values."""
    runs = study.runs
    memory = runs["memory_bytes"].iloc[0] / 2**30
    told = {name: _values(runs[column]) for name, column in FACTS.items()}
    hardware = _values(runs["hardware_threads"])
    virtual = "yes (shares its hardware with others)" if bool(runs["virtualised"].iloc[0]) else "no"
    told |= {
        "Cores": f"{told['Cores']} cores, {hardware} hardware threads",
        "Virtual machine": virtual,
        "Memory": f"{number(memory)} GiB",
        "Source revision": study.revision,
        "Programs (SHA-256)": _values(runs["binary_sha256"].str[:16]),
        "Measured": f"{runs['recorded_at'].min()} to {runs['recorded_at'].max()} (UTC)",
        "Sessions": exact(runs["session"].nunique()),
        "Records": f"{exact(len(runs))} processes, {exact(timed_runs(study.times))} timed runs",
        "In the clock": in_the_clock(study),
    }
    return list(told.items())


def in_the_clock(study: Study) -> str:
    """Say which part of the time, from the first record of each session to its last, was in the clock of what
    is compared, and what else its processes took. Counts are not compared by their time.
    """
    compared = study.times[study.times["question_kind"] != COUNTS]
    at = pd.to_datetime(study.runs["recorded_at"]).groupby(study.runs["session"])
    whole = float((at.max() - at.min()).dt.total_seconds().sum())
    timed = float(compared[runs_of("steps_seconds")].map(sum).sum())
    processes = float(study.runs["process_seconds"].sum())
    if whole < timed:
        return f"{number(timed)} s of {number(processes)} s of the processes"
    return f"{number(timed)} s of {number(whole)} s ({share(timed / whole)}); processes {number(processes)} s"


def _values(column: pd.Series) -> str:
    values = {exact(one) if isinstance(one, float) else str(one) for one in column.dropna().unique()} - {""}
    return "; ".join(sorted(values)) or UNTOLD


def checks(study: Study) -> str:
    """Say how many results were checked, how, and the greatest error measures found."""
    runs = study.runs
    verdicts = runs["check_verdict"].value_counts()
    return tell(
        "checks", passed=verdicts.get("passed", 0), failed=study.failed_checks(),
        scopes=sorted(set(runs["check_scope"]) - {"nothing"}), drift=runs["energy_drift"].abs().max(),
        discs=runs["discs_outside"].max(), unchecked=verdicts.get("unchecked", 0),
    )  # fmt: skip


def partners(study: Study) -> str:
    """Say which records are in no ratio, and why; nothing if all of them are."""
    runs = study.runs[study.runs["check_verdict"] != "failed"]
    groups = ((name, without_partner(group)) for name, group in runs.groupby("experiment"))
    return tell("partners", lone=[f"{by_series(lone)} ({name})" for name, lone in groups if len(lone)])


def missing_counters(counters: pd.DataFrame) -> list[dict[str, str]]:
    """Return each reason why counters have no value, with the counters and the remedy."""
    missing = counters[counters["value"].isna()].fillna({"reason": UNTOLD, "remedy": "none known"})
    keys = ["source", "reason", "remedy"]
    return [
        {**dict(zip(keys, key, strict=True)), "names": ", ".join(sorted(group["name"].unique()))}
        for key, group in missing.groupby(keys)
    ]


def verbs(records: Records, questions: str) -> list[str]:
    """Return the project's own commands that repeat the whole of it, in order; its questions are in that
    folder, or the published ones.
    """
    families = set(records.runs["compiler_family"])
    builds = [f"make build COMPILER={name}" for name in ("gcc", "clang") if name in families]
    scales = sorted(set(records.runs["scale"]) - {"unstated"})
    studies = [
        f"make experiments{_study(records, scale)} SCALE={scale}{setting(questions)}" for scale in scales
    ]
    return ["make setup", *(builds or ["make build"]), *(studies or ["make experiments"]), "carom report"]


def _study(records: Records, scale: str) -> str:
    """Return ` STUDY=` with the questions of that scale, nothing if all of the published ones are among
    them; the control is among them in any case.
    """
    tables = (records.runs, records.failures)
    present = {name for table in tables for name in table.loc[table["scale"] == scale, "experiment"]}
    if present.issuperset(titles()):
        return ""
    return f" STUDY={','.join(sorted(present - {CONTROL}) or [CONTROL])}"


def commands(runs: pd.DataFrame) -> list[str]:
    """Return the commands behind the points of one experiment, each once, rebuilt from the records' own
    fields. One process of a point measures its errors, too: the command says so.
    """
    with_errors = runs.groupby(["series", "x", "scene"])["has_errors"].transform("any")
    ordered = runs.assign(has_errors=with_errors).sort_values(["series", "x"], kind="stable")
    return list(dict.fromkeys(map(_command, ordered.to_dict("records"))))


def _command(row: dict[str, Any]) -> str:
    if row["kind"] == "process":
        return f"{row['environment']} {row['command']}".strip()
    words = [f"build/{row['compiler_family']}/carom", row["kind"], row["scene"], "--variant", row["variant"]]
    for option in ("threads", "substeps", "tolerance"):
        words += [f"--{option}", str(row[option])]
    for option in ("find_chunk", "resolve_chunk"):
        if not pd.isna(row[option]):
            words += [f"--{option.replace('_', '-')}", f"{row[option]:g}"]
    words += ["--warm-up", str(row["warm_ups"])]
    if row["kind"] == "bench":
        words += ["--repetitions", str(row["repetitions"])]
    if row["has_errors"]:
        words += ["--errors", "--record", "record.json"]
    return f"{row['environment']} {shlex.join(words)}".strip()
