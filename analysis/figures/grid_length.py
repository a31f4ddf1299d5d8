"""Time over the side length with the discs fixed: the published variant pays for empty space, others may
not.
"""

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.ladder import per_disc_step, speed_up
from analysis.figures.captions import minimum_sentence, opening
from analysis.figures.curves import colours, curve, published_curve
from analysis.figures.labels import label_ends
from analysis.figures.style import Data, Drawing, lighten, logarithmic_ticks, new_figure, plain_ticks
from analysis.figures.sweeps import ranges_agree, trend
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.statistics.verdicts import error_of_picked, judge_one
from analysis.support.wording import exact, interval_of, number

EXPERIMENT = "grid_length"
SUBJECT = "Time over the side length"
PUBLISHED = "published"


def grid_length(data: Data) -> Drawing | None:
    """Draw time per disc and step over the side length, on logarithmic axes so that both ends can be read."""
    times = data.study.times_of(EXPERIMENT)
    if times["series"].nunique() < 2:
        return trend(data, EXPERIMENT, SUBJECT, "side length", minimum_sentence)
    summary = summarise(per_disc_step(times), ["series", "x"], value="nanoseconds")
    shades = colours(times)
    figure, (axes,) = new_figure(3.2)
    axes.set(xscale="log", yscale="log", xlabel="side length", ylabel="time per disc and step, ns")
    for series, part in summary.groupby("series"):
        curve(axes, part, shades[str(series)])
    plain_ticks(axes.xaxis, _few(summary["x"]))
    logarithmic_ticks(axes.yaxis)
    ends = summary.loc[summary.groupby("series")["x"].idxmax()]
    labels = [(row["series"], row["median"], shades[row["series"]]) for row in ends.to_dict("records")]
    published = data.published.experiment(EXPERIMENT)
    ours = summary[summary["series"].isin(published["series"])]
    beside = not ours.empty and ranges_agree(ours["x"], published["x"])
    if beside:
        labels += [_published(axes, ours, published, shades)]
    label_ends(axes, labels)
    note = (
        " Lighter: the published series, its times moved so that its median is level with ours."
        if beside
        else ""
    )
    return Drawing(figure, opening(times, SUBJECT) + _sentences(times) + note)


def _few(x: pd.Series) -> list[float]:
    """Return the largest value and smaller ones so far apart that their names fit a logarithmic axis."""
    kept: list[float] = []
    for value in sorted(x.unique(), reverse=True):
        if not kept or value < kept[-1] / 1.35:
            kept.append(float(value))
    return kept


def _published(
    axes: Axes, ours: pd.DataFrame, published: pd.DataFrame, shades: dict[str, str]
) -> tuple[str, float, str]:
    """Draw the published curve moved to the median of ours; return its label."""
    factor = ours["median"].median() / published["seconds"].median()
    moved = published["seconds"] * factor
    colour = shades[str(ours["series"].iloc[0])]
    published_curve(axes, published["x"].to_list(), moved.to_list(), colour)
    return (
        f"as published, {number(published['seconds'].iloc[-1])} s",
        float(moved.iloc[-1]),
        lighten(colour, 0.4),
    )


def _sentences(times: pd.DataFrame) -> str:
    """Say of each series how the time changes, and by how much each is faster than the published one."""
    processes = process_medians(times)
    first = processes[processes["variant"] == PUBLISHED]
    said = []
    for series, part in processes.groupby("series"):
        if len(first) and part["variant"].iloc[0] == PUBLISHED:
            said.append(f" {series}:{minimum_sentence(times[times['series'] == series])}")
            continue
        said.append(f" {series}:{_flatness(part)}{_against(first, part)}")
    return "".join(said)


def _flatness(processes: pd.DataFrame) -> str:
    """Say how far the times of a series are apart from its second x on: the first is the dense spike."""
    curve_of = processes.groupby("x")["steps_seconds"].median().sort_index()
    rest = curve_of.iloc[1:]
    if len(rest) < 2:
        return ""
    ends = [processes[processes["x"] == x] for x in (rest.idxmin(), rest.idxmax())]
    row = judge_one(log_ratios(*ends)["log_ratio"], error=error_of_picked(len(rest)))
    return (
        f" From {exact(rest.index[0])} on, the greatest time (at {exact(rest.idxmax())}) is "
        f"{interval_of(row, 'ratio')} times the least (at {exact(rest.idxmin())})."
    )


def _against(first: pd.DataFrame, processes: pd.DataFrame) -> str:
    """Say by how much a series is faster than the published one at the smallest and the largest shared x."""
    shared = sorted(set(first["x"]) & set(processes["x"]))
    if not shared:
        return ""
    said = []
    for x in dict.fromkeys((shared[0], shared[-1])):
        row = judge_one(log_ratios(first[first["x"] == x], processes[processes["x"] == x])["log_ratio"])
        said.append(f"{speed_up(row)} at {exact(x)}")
    return f" It is faster than the published variant by {' and '.join(said)}."
