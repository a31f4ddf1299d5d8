"""What `run --error-below` promised, what it delivered, and how much dearer it was than need be."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, tell
from analysis.figures.labels import key
from analysis.figures.speed_against_error import power_of_ten
from analysis.figures.style import BLUE, FAINT, GREEN, INK, VERMILLION, Data, Drawing, new_figure
from analysis.support.values import Cell, Table, table_of
from analysis.support.wording import count, factor, number

MEASURES = {
    "path": ("paths", BLUE),
    "collision_rate": ("collision rate", VERMILLION),
    "pressure": ("pressure", GREEN),
}
DEARER = 1.5
"""Times the cheapest that a choice should cost at most."""

FLOOR = 1e-16
"""Where an error of zero stands on an axis of powers of ten."""


def promises(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw delivered against promised errors, and what each choice cost beside the cheapest that would do."""
    (every,) = data.study.of(experiment, "promises")
    made = every[every["ratio"].notna()]
    if made.empty:
        return None
    figure, (errors, costs) = new_figure(3.1, 2, [1.25, 1])
    _errors(errors, made)
    _costs(costs, made)
    measured = set(made["measure"])
    present = [(f"● {name}", colour) for measure, (name, colour) in MEASURES.items() if measure in measured]
    key(errors, [*present, ("○ broken", INK)])
    return Drawing(figure, _caption(subject, every, made), tables=[_table(made)])


def _errors(axes: Axes, made: pd.DataFrame) -> None:
    bounds = sorted(made["error_below"].unique())
    for number_of, bound in enumerate(bounds):
        of_bound = made[made["error_below"] == bound].sort_values(["measure", "particles"])
        places = number_of + np.linspace(-0.36, 0.36, len(of_bound))
        for place, row in zip(places, of_bound.to_dict("records"), strict=True):
            colour = MEASURES[row["measure"]][1]
            low, high = max(row["delivered"], FLOOR), max(row["promised"], FLOOR)
            axes.plot([place, place], [low, high], color=colour, linewidth=0.6, alpha=0.5, zorder=2)
            inside = colour if row["kept"] else "white"
            (dot,) = axes.plot(place, low, "o", color=colour, mfc=inside, markersize=3.2, zorder=3)
            told = f"promised {row['promised']:.2g}, delivered {row['delivered']:.2g}"
            tell(dot, [Told(f"{row['scene_name']}, {row['method']}", told)])
            (mark,) = axes.plot(place, high, "_", color=colour, markersize=4, zorder=3)
            tell(mark, [Told(f"{row['scene_name']}, promised", f"{row['promised']:.2g}")])
        axes.plot([number_of - 0.45, number_of + 0.45], [bound, bound], color=INK, linewidth=1.1)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(lambda value, _: "0" if value <= FLOOR else power_of_ten(value))
    axes.minorticks_off()
    axes.set_xticks(range(len(bounds)), [f"below {bound:g}" for bound in bounds])
    axes.tick_params(axis="x", length=0)
    axes.set_ylabel("error: • delivered, – promised, ▬ bound")


def _costs(axes: Axes, made: pd.DataFrame) -> None:
    for measure, (name, colour) in MEASURES.items():
        of_measure = made[made["measure"] == measure].sort_values("ratio")
        if of_measure.empty:
            continue
        share = np.arange(1, len(of_measure) + 1) / len(of_measure)
        (line,) = axes.step(of_measure["ratio"], share, where="post", color=colour, marker=".", markersize=3)
        told = [
            Told(f"{name}: {row['scene_name']}, below {row['error_below']:g}", factor(row["ratio"]))
            for row in of_measure.to_dict("records")
        ]
        tell(line, told)
    axes.axvline(DEARER, color=FAINT, linewidth=0.8, linestyle=":")
    axes.set_xlim(0.98, max(1.6, 1.05 * made["ratio"].max()))
    axes.set_ylim(0, 1.03)
    axes.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f} %")
    axes.set_ylabel("promises that cost at most this")
    axes.set_xlabel("time relative to the cheapest that does")


def _caption(subject: str, every: pd.DataFrame, made: pd.DataFrame) -> str:
    kept = "; ".join(
        f"{name} {int(group['kept'].sum())} of {len(group)}"
        for measure, (name, _) in MEASURES.items()
        if len(group := made[made["measure"] == measure])
    )
    unmade = len(every) - len(made)
    none = f" For {count(unmade, 'bound')} no method was known to do." if unmade else ""
    scenes = count(every["scene_name"].nunique(), "scene")
    threads = count(int(every["threads"].iloc[0]), "thread")
    return (
        f"{subject[0].upper()}{subject[1:]}: what `carom run --error-below` chose on {scenes} ({threads}). "
        f"Left: a dot is the error of the whole run, the bar joined to it what was promised. Kept: {kept}."
        f"{none} {_cost_sentence(made)}"
    )


def _cost_sentence(made: pd.DataFrame) -> str:
    cheap = int((made["ratio"] <= DEARER).sum())
    worst = made.loc[made["ratio"].idxmax()]
    where = f"{worst['scene_name']}, {MEASURES[worst['measure']][0]} below {worst['error_below']:g}"
    return (
        f"Right: time of the chosen run over that of the cheapest of {int(made['methods'].max())} methods "
        f"whose run keeps the bound, each the least of several in turns: at most {number(DEARER)} in {cheap} "
        f"of {len(made)}, {factor(worst['ratio'])} in the worst ({where}). Choosing took "
        f"{number(made['trial_seconds'].median())} s (median), {number(made['trial_seconds'].max())} s at "
        "most."
    )


def _table(made: pd.DataFrame) -> Table:
    rows = [
        [
            row["scene_name"],
            f"{MEASURES[row['measure']][0]} below {row['error_below']:g}",
            f"{row['promised']:.2g}",
            Cell(f"{row['delivered']:.2g}", "holds" if row["kept"] else "fails"),
            Cell(factor(row["ratio"]), "open" if row["ratio"] > DEARER else ""),
            row["method"],
        ]
        for row in made.to_dict("records")
    ]
    columns = ["scene", "error", "promised", "delivered", "times the cheapest", "chosen"]
    return table_of("Every promise:", columns, rows)
