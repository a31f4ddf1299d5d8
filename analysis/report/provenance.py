"""Where the records come from, as tables for the report: machine, checks, missing counters, commands."""

import shlex
from typing import Any

import pandas as pd

from analysis.claims.entry import setting
from analysis.figures import titles
from analysis.figures.captions import by_series
from analysis.records.reading import Records
from analysis.records.studies import Study
from analysis.statistics.pairs import runs_of, timed_runs, without_partner
from analysis.support.wording import count, exact, number, share
from support.vocabulary import CONTROL, COUNTS

UNTOLD = "not told by the system"


def machine(study: Study) -> list[tuple[str, str]]:
    """Return what is known of the machine and the programs, as names and (all) values."""
    runs = study.runs
    memory = runs["memory_bytes"].iloc[0] / 2**30
    virtual = {True: "yes (shares its hardware with others)", False: "no"}[bool(runs["virtualised"].iloc[0])]
    return [
        ("Hosts", _values(runs["node"])),
        ("CPU", _values(runs["cpu_model"])),
        ("Cores", f"{_values(runs['cores'])} cores, {_values(runs['hardware_threads'])} hardware threads"),
        ("CPUs usable", _values(runs["affinity"])),
        ("Virtual machine", virtual),
        ("Clock governor", _values(runs["governor"])),
        ("Memory", f"{number(memory)} GiB"),
        ("Operating system", _values(runs["operating_system"])),
        ("OpenMP", _values(runs["openmp"])),
        ("OpenMP settings", _values(runs["environment"])),
        ("Compilers", _values(runs["compiler"])),
        ("Compiler flags", _values(runs["compiler_flags"])),
        ("Build", _values(runs["build_type"])),
        ("Source revision", study.revision),
        ("Programs (SHA-256)", _values(runs["binary_sha256"].str[:16])),
        ("Measured", f"{runs['recorded_at'].min()} to {runs['recorded_at'].max()} (UTC)"),
        ("Sessions", exact(runs["session"].nunique())),
        ("Records", f"{exact(len(runs))} processes, {exact(timed_runs(study.times))} timed runs"),
        ("In the clock", in_the_clock(study)),
    ]


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
    drift = runs["energy_drift"].abs().max()
    passed = count(int((runs["check_verdict"] == "passed").sum()), "result")
    failed = study.failed_checks()
    said = f"{passed} passed and {count(failed, 'result')} failed the program's own check"
    scopes = " and ".join(sorted(set(runs["check_scope"]) - {"nothing"}))
    energy = "" if pd.isna(drift) else f"; greatest relative drift of energy {drift:.1e}"
    discs = runs["discs_outside"].max()
    outside = "" if pd.isna(discs) else f"; at most {count(int(discs), 'disc')} outside the box at the end"
    unchecked = int((runs["check_verdict"] == "unchecked").sum())
    unseen = f"; {count(unchecked, 'process')} of programs whose results are not checked" if unchecked else ""
    return f"{said} ({scopes}){energy}{outside}{unseen}."


def partners(study: Study) -> str:
    """Say which records are in no ratio, and why; nothing if all of them are."""
    runs = study.runs[study.runs["check_verdict"] != "failed"]
    lone = [
        f"{by_series(alone)} ({name})"
        for name, group in runs.groupby("experiment")
        if len(alone := without_partner(group))
    ]
    if not lone:
        return ""
    return (
        "A ratio is taken only of what one session measured together. These records have no partner, and "
        f"count in times alone: {'; '.join(lone)}. A partner is lost where a program or a question was "
        "changed, a point failed, or a run ended within a block. What lost it is measured again with it."
    )


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
