"""One scene on every machine whose records are present, with the published machines."""

import pandas as pd

from analysis.figures.captions import differing
from analysis.figures.curves import dots
from analysis.figures.style import BLUE, Data, Drawing, lighten, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.statistics.unpaired import judge_unpaired
from analysis.statistics.verdicts import corrected
from analysis.support.wording import count, exact


def machines(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the time on each machine, a row a series: every study at this scale, never merged."""
    present = [study for study in data.studies if study.scale == data.study.scale]
    times = pd.concat([study.times_of(experiment).assign(machine=study.machine) for study in present])
    if times.empty:
        return None
    several = [key for key in ("revision", "series") if times.groupby("machine")[key].nunique().max() > 1]
    times = times.assign(told=times[["machine", *several]].agg(", ".join, axis=1))
    times["name"] = times["told"].str.replace(": ", "\n", n=1).str.replace(", ", "\n", n=1)
    summary = summarise(times, ["name"]).sort_values("median", ascending=False)
    published = data.published.experiment(experiment).groupby("series")["seconds"].median().sort_values()
    caption = _caption(times, subject)
    rows = max(len(summary), len(published))
    figure, axes = new_figure(0.7 + 0.42 * rows, columns=1 if published.empty else 2)
    dots(axes[0], summary, "name")
    axes[0].set_xlabel("time of the steps, s")
    if not published.empty:
        axes[0].set_title("measured")
        theirs = published[::-1].rename("median").reset_index()
        gigahertz = data.published.machines.set_index("machine")["maximum_gigahertz"]
        theirs["name"] = [f"{name}\n{gigahertz[name]} GHz" for name in theirs["series"]]
        dots(axes[1], theirs, "name", lighten(BLUE, 0.4))
        axes[1].set(xlabel="time of the process, s", title="published, 16 threads")
    return Drawing(figure, caption)


def _caption(times: pd.DataFrame, subject: str) -> str:
    threads = sorted(times["threads"].unique())
    on = " or ".join(count(int(number), "thread") for number in threads)
    caption = (
        f"{subject} (N = {exact(times['particles'].iloc[0])}, {on}): medians with 95 % "
        f"bootstrap intervals, {count(times['file'].nunique(), 'process')}.{_hosts(times)}"
    )
    groups = {name: group["steps_seconds"] for name, group in times.groupby("told")}
    if times["machine"].nunique() < 2:
        return f"{caption} Only one machine is present; more appear when their results are collected."
    # By name: were the fastest chosen, the verdicts against it would be biased.
    first = min(groups)
    others = [name for name in groups if name != first]
    table = corrected(pd.DataFrame([judge_unpaired(groups[first], groups[name]) for name in others]))
    return f"{caption} Against {first} (not interleaved, so unpaired): {differing(others, table)}."


def _hosts(times: pd.DataFrame) -> str:
    """Say which nodes of a partition were used; what is no partition has its host in its name."""
    nodes = times.groupby("machine")["node"].unique()
    used = [
        f"{machine} on {', '.join(sorted(names))}"
        for machine, names in nodes.items()
        if not str(machine).startswith(f"{names[0]}: ")
    ]
    return f" Nodes: {'; '.join(used)}." if used else ""
