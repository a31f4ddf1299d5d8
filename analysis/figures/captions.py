"""What captions say: the facts of the measurements in rows, put into words by `captions.jinja`."""

import re
from collections.abc import Callable
from types import ModuleType
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined

from analysis.derived.ladder import speed_up
from analysis.statistics.pairs import timed_runs, without_partner
from analysis.statistics.trends import growth, linearity, minimum
from analysis.support import wording
from analysis.support.wording import count, exact

MEDIANS = "Dots are medians, bars their 95 % bootstrap intervals"
PROCESSES = "A dot is the median of one process"
SCENES = "A dot is the geometric mean over the seeds in one block"

SAMPLES = {"file": "process", "block": "block", "session": "session"}

Course = tuple[str, Any]
"""What a curve does: what it was asked, and what was found."""


def environment(package: str, *modules: ModuleType, **more: Any) -> Environment:  # noqa: ANN401
    """Return what renders a package's templates, in which numbers are said as everywhere else, and what the
    functions of these modules say, too.
    """
    made = Environment(loader=PackageLoader(package, "."), undefined=StrictUndefined, **more)
    words = {name: word for one in (wording, *modules) for name, word in vars(one).items() if callable(word)}
    made.filters |= words | {
        "speed_up": speed_up,
        "capital": lambda text: text[0].upper() + text[1:],
        "g": "{:g}".format,
    }
    return made


def teller(package: str, file: str) -> Callable[..., str]:
    """Return what says in one line what a macro of a package's template makes of facts, by its name."""
    words = environment(package).get_template(file)

    def tell(macro: str, /, **facts: Any) -> str:  # noqa: ANN401
        return re.sub("[ \n]+", " ", getattr(words.module, macro)(**facts)).strip()

    return tell


caption = teller("analysis.figures", "captions.jinja")


def opening(times: pd.DataFrame, subject: str, dots: str = MEDIANS) -> str:
    """Say what is drawn, on which scene and threads, from how many processes, blocks and sessions."""
    columns = {"N": "particles", "L": "side", "r": "radius", "steps": "steps"}
    fixed = [
        f"{name} = {exact(times[column].iloc[0])}"
        for name, column in columns.items()
        if times[column].nunique() == 1
    ]
    if times["threads"].nunique() == 1:
        fixed.append(count(int(times["threads"].iloc[0]), "thread"))
    whole = times[times["kind"] == "process"]
    # Which series had no turns where others did, and why.
    alone = whole.dropna(subset=["undisturbed"]).drop_duplicates("series").sort_values("series")
    return caption(
        "opening", subject=subject, fixed=fixed, dots=dots, runs=timed_runs(times), whole=len(whole),
        amounts={noun: times[of].nunique() for of, noun in SAMPLES.items()},
        lone=by_series(without_partner(times)), alone=list(alone.itertuples()),
        own=sorted(whole.loc[whole["time_from"] != "outside", "series"].unique()),
    )  # fmt: skip


def by_series(runs: pd.DataFrame) -> str:
    """Return how many runs there are of each series, in words."""
    return wording.listed(f"{number} of {series}" for series, number in runs.groupby("series").size().items())


def time_axis(times: pd.DataFrame) -> str:
    """Return what the axis of the times is called."""
    return "time, s" if (times["kind"] == "process").any() else "time of the steps, s"


def course_of(times: pd.DataFrame, asked: str = "growth") -> Course:
    """Return what the time does over x, of a single series: its `minimum`, whether it is `linear`, or its
    `growth`, which is told as well of too few points for the others.
    """
    if asked == "minimum" and times["x"].nunique() > 2:
        return asked, minimum(times)
    if asked == "linear" and (found := linearity(times)).is_measured:
        return asked, found
    return ("growth", growth(times)) if times["x"].nunique() > 1 else ("", None)
