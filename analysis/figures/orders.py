"""Resolve orders against each other: row against checkered over scene size, and the sequential orders."""

from analysis.derived.comparisons import differences, reference
from analysis.derived.ladder import per_disc_step
from analysis.figures.captions import differing, opening
from analysis.figures.comparisons import differences_sentence
from analysis.figures.curves import curve, curves, dots, faint_dots
from analysis.figures.labels import from_zero, label_ends, plain_ticks
from analysis.figures.style import BAND, BLUE, FAINT, INK, VERMILLION, Data, Drawing, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import ratios_of
from analysis.statistics.verdicts import MARGIN, judge
from analysis.support.wording import exact

COLOURS = {"checkered": BLUE, "row": VERMILLION}


def row(data: Data) -> Drawing | None:
    """Draw alternate rows against the checkered pattern over scene size: time per disc, paired ratio."""
    times = data.study.times_of("row")
    if times.empty:
        return None
    figure, (left, right) = new_figure(2.6, columns=2)
    scaled = summarise(per_disc_step(times), ["series", "x"], value="nanoseconds")
    ends = curves(left, scaled, {series: COLOURS.get(series, INK) for series in scaled["series"]})
    left.set(xscale="log", xlabel="discs", ylabel="time per disc and step, ns")
    from_zero(left)
    table = judge(ratios_of(times, "order", "checkered", "row", match=("x",)), ["x"])
    percent = table.assign(**{end: 100 * (table[end] - 1) for end in ("ratio", "low", "high")})
    right.axhspan(-100 * MARGIN, 100 * MARGIN, color=BAND, zorder=0, linewidth=0)
    right.axhline(0, color=FAINT, linewidth=0.7)
    curve(right, percent, INK, "ratio")
    right.set(xscale="log", xlabel="discs", ylabel="time of row against checkered, %")
    for axes in (left, right):
        plain_ticks(axes.xaxis)
    label_ends(left, ends)
    said = differing((f"{exact(x)} discs" for x in table["x"]), table)
    caption = (
        opening(times, "Alternate rows against the checkered pattern, over scene size at one density")
        + f" Time of row against checkered: {said} (Holm-corrected, margin shaded). The published study "
        "states that row wins on large scenes, without a number."
    )
    names = [f"row against checkered, {exact(x)} discs" for x in table["x"]]
    return Drawing(figure, caption, table.assign(name=names))


def sequential_orders(data: Data) -> Drawing | None:
    """Draw the sequential resolve orders against each other, the published ones beside them."""
    times = data.study.times_of("sequential_orders")
    if times.empty:
        return None
    summary = summarise(times, ["series"]).sort_values("median", ascending=False)
    figure, (axes,) = new_figure(0.8 + 0.45 * len(summary))
    dots(axes, summary, "series")
    medians = summary.set_index("series")["median"]
    published = {
        name: data.published.experiment(f"self_contained_{name}").query("series == 'on'")["seconds"].median()
        for name in ("track", "repeat")
    }
    if "track" in medians:
        scale = medians["track"] / published["track"]
        heights = {str(name): height for height, name in enumerate(medians.index)}
        faint_dots(axes, [(heights[name], scale * one) for name, one in published.items() if name in heights])
    axes.set_xlabel("time of the steps, s")
    against = reference(times)
    table = differences(times, against)
    caption = opening(times, "The sequential resolve orders") + differences_sentence(table, against)
    caption += " Lighter: the published medians with self-contained resolves, scaled so that track is level."
    names = [f"{series} against {against}" for series in table["series"]]
    return Drawing(figure, caption, table.assign(name=names))
