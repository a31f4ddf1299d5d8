"""Points tell their value and interval in the SVG, each at its own place."""

import re
from html import unescape
from pathlib import Path
from xml.etree import ElementTree

from matplotlib.figure import Figure

from analysis.figures import draw_all
from analysis.figures.labels import label_points
from analysis.figures.style import Drawing, point, save
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import study

MARK = re.compile(
    r'<g id="point-\d+"><title>([^<]*)</title>.*?<use [^>]*x="([-\d.]+)" y="([-\d.]+)"', re.DOTALL
)


def marks(svg: Path) -> list[tuple[float, float, str]]:
    text = svg.read_text(encoding="utf-8")
    ElementTree.fromstring(text)
    return [(float(x), float(y), unescape(said)) for said, x, y in MARK.findall(text)]


def test_a_point_tells_its_x_its_value_and_its_interval(tmp_path: Path) -> None:
    write(tmp_path, study(["steps"], blocks=6, noise=QUIET))
    (drawn,) = draw_all(tmp_path)
    measured = [mark for mark in marks(drawn.files[0]) if "time of the steps" in mark[2]]
    assert len(measured) == 10
    said = sorted(measured)[0][2].split("\n")
    assert said[:2] == ["checkered", "number of steps: 20"]
    assert re.fullmatch(r"time of the steps, s: 0\.16\d? \[0\.1[56]\d?, 0\.16\d?\]", said[2])


def test_the_words_are_those_of_the_point_at_that_place(tmp_path: Path) -> None:
    figure = Figure(figsize=(4, 3))
    axes = figure.add_subplot(xlabel="size", ylabel="time,\ns", xlim=(0, 10), ylim=(1, 100), yscale="log")
    for x, y in ((9.0, 2.0), (1.0, 50.0)):
        point(axes, x, y, "o", "<a>", str(x), str(y))
    (file,) = save(Drawing(figure, ""), tmp_path, "drawn")
    found = {said: place for *place, said in marks(file)}
    low, high = found["<a>\nsize: 9.0\ntime, s: 2.0"], found["<a>\nsize: 1.0\ntime, s: 50.0"]
    assert low[0] > high[0]
    assert low[1] > high[1]


def test_labels_beside_points_lie_on_no_other() -> None:
    figure = Figure(figsize=(3, 3))
    axes = figure.add_subplot(xlim=(0, 1), ylim=(0, 1))
    close = [(str(2**number), 0.5 + 0.01 * number, 0.5) for number in range(7)]
    apart = [("64", 0.1, 0.1), ("32", 0.9, 0.1)]
    label_points(axes, [*close, *apart], "black")
    boxes = [text.get_window_extent() for text in axes.texts]
    assert 4 <= len(boxes) < len(close) + len(apart), "what has no room is left out"
    assert {"64", "32", "1"} <= {text.get_text() for text in axes.texts}
    for number, one in enumerate(boxes):
        assert not any(one.overlaps(other) for other in boxes[:number])
