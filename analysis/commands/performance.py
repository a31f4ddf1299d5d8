"""The ladder, the limits and the speed of the exact simulation as Markdown tables, for documents."""

import pandas as pd

from analysis.derived.exact_threads import CURVE, rates
from analysis.derived.ladder import RUNG, claims, factors, named, rungs, scene_title, speed_up, tables_of
from analysis.derived.limits import against_limits
from analysis.records.studies import Study
from analysis.support.values import Row
from analysis.support.wording import count, interval_of, markdown_table, number, share

RUNGS = [
    *("rung", "ns per disc and step", "factor", "resolves per disc and step", "sweeps per step"),
    "checks passed",
]


def markdown(study: Study) -> str:
    """Return every table that the study has records for, empty if there is none."""
    parts = [
        _ladder(study, "ladder"),
        _limits(study),
        _phases(study, "limits"),
        _rates(study, "exact_threads"),
    ]
    return "\n\n".join(part for part in parts if part)


def _ladder(study: Study, experiment: str) -> str:
    tables = tables_of(study, experiment)
    if tables is None:
        return ""
    runs, times = tables
    judged = factors(times)[[*RUNG, "ratio", "low", "high"]]
    table = rungs(runs, times, study.counters).drop(columns=["low", "high"])
    table = table.merge(judged, on=RUNG, how="left")
    lines = [f"- {sentence}" for sentence in claims(runs, times)]
    for scene, rows in table.groupby("scene_name", sort=False):
        body = [
            [
                row["change"], number(row["nanoseconds"]), speed_up(row) if pd.notna(row["ratio"]) else "",
                number(row["resolves"]), number(row["sweeps"]), f"{row['passed']} of {row['records']}",
            ]
            for row in rows.sort_values("series_number").to_dict("records")
        ]  # fmt: skip
        lines += ["", f"{scene_title(runs, str(scene))}:", "", markdown_table(RUNGS, body)]
    return "\n".join(lines)


def _limits(study: Study) -> str:
    keys = ["limit", "working_set_bytes", "lanes", "threads"]
    # Measured more than once, a limit is the greatest: what the machine did, it can do.
    greatest = study.limits.groupby(keys, dropna=False)["best"].idxmax()
    rows = [
        [_what(row), str(row["threads"]), number(1e-9 * row["best"]), number(1e-9 * row["median"])]
        for row in study.limits.loc[greatest.sort_values()].to_dict("records")
    ]
    return markdown_table(["limit", "threads", "best, 1e9/s", "median"], rows) if rows else ""


def _what(row: Row) -> str:
    if row["limit"] == "copy":
        return f"copy within {number(row['working_set_bytes'] / 2**20)} MiB ({row['level']}), bytes"
    return f"arithmetic, {row['lanes']:.0f} at once, operations"


def _phases(study: Study, experiment: str) -> str:
    runs, phases, threads = map(named, study.of(experiment, "runs", "phases", "threads"))
    table = against_limits(runs, phases, threads, study.limits)
    body = [
        [
            scene_title(runs, row["scene_name"]), row["series"], row["phase"],
            *(number(row[name]) for name in ("bytes", "operations", "copy", "arithmetic", "wall")),
            share(row["reached"]), share(1 - row["busy"] / row["wall"]),
        ]
        for row in table.to_dict("records")
    ]  # fmt: skip
    head = ["scene", "variant", "phase", "bytes", "operations", "least by copying, ns", "by arithmetic, ns"]
    return markdown_table([*head, "measured, ns", "reached", "waiting"], body) if body else ""


def _rates(study: Study, experiment: str) -> str:
    runs, times = study.of(experiment, "runs", "times")
    if times.empty:
        return ""
    table = rates(runs[runs["check_verdict"] != "failed"], times)
    threads = sorted(table["x"].unique())
    head = [f"million collisions a second, {count(int(x), 'thread')}" for x in threads]
    head += [f"speed-up, {count(int(x), 'thread')}" for x in threads[1:]]
    body = []
    for (scene, series), rows in table.groupby(CURVE, sort=False):
        by_x = rows.set_index("x")
        body.append(
            [
                scene or series,
                *(number(1e-6 * by_x.loc[x, "rate"], 2) if x in by_x.index else "–" for x in threads),
                *(interval_of(by_x.loc[x], "speed_up") if x in by_x.index else "–" for x in threads[1:]),
            ]
        )
    return markdown_table(["scene", *head], body)
