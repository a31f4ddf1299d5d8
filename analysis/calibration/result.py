"""From a folder's streams to its tables and its figure."""

from pathlib import Path

from analysis.calibration.figure import NAME, draw
from analysis.calibration.markdown import markdown
from analysis.calibration.streams import load
from analysis.calibration.studies import all_studies
from analysis.calibration.tables import STREAM, errors, ours_and_theirs, power
from analysis.calibration.usual_ways import all_ways
from analysis.figures.style import save
from support.errors import InputError
from support.files import replacing


def write(folder: Path) -> tuple[str, list[Path]]:
    """Write `calibration.md` and `calibration.svg` beside the streams; return the tables and the files.

    Raises InputError where there are no streams, or none with enough blocks for a single look.
    """
    calibration = load(folder)
    studies = all_studies(calibration.streams)
    if studies.empty:
        raise InputError(f"{folder}: no stream has enough blocks for a verdict, expected a longer time")
    compared = ours_and_theirs(studies, all_ways(calibration.streams), calibration.streams)
    by_truth = errors(studies[studies["reference"] == 0].sort_values("more", kind="stable"), ["more"])
    tables = markdown(errors(studies, STREAM), by_truth, power(studies), compared)
    text = f"{calibration.origin}\n\n{tables}\n"
    target = folder / f"{NAME}.md"
    with replacing(target) as part:
        part.write_text(text, encoding="utf-8")
    return text, [target, *save(draw(compared, calibration.origin), folder, NAME, formats=("svg",))]
