import json
from pathlib import Path

import pytest

from analysis.records import timelines
from analysis.tests.synthetic_study import trace


def write(folder: Path, name: str, text: str) -> None:
    (folder / timelines.FOLDER).mkdir(exist_ok=True)
    (folder / timelines.FOLDER / name).write_text(text)


def test_spans_know_their_thread_phase_and_kind(tmp_path: Path) -> None:
    write(tmp_path, "a.json", json.dumps(trace("guided", chunks=4, steps=3, threads=2)))
    (one,) = timelines.load(tmp_path)
    assert one.title == "guided"
    kinds = one.spans.groupby("kind").size()
    assert kinds.to_dict() == {"phase": 12, "loop": 24, "wait": 24, "chunk": 96}
    assert set(one.spans["thread"]) == {0, 1}
    assert one.spans["end"].max() == pytest.approx(0.03)


def test_the_step_of_median_length_is_cut_out(tmp_path: Path) -> None:
    made = trace("static", chunks=1, steps=3)
    for event in made["traceEvents"]:
        if event["ts"] >= 20_000:
            event["ts"] += 5_000
    write(tmp_path, "a.json", json.dumps(made))
    step = timelines.one_step(timelines.load(tmp_path)[0].spans)
    assert list(step.loc[step["kind"] == "phase", "phase"]) == ["move", "bin", "find", "resolve"]
    assert step["begin"].min() == 0
    assert step["end"].max() == pytest.approx(0.01)


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"traceEvents": [], "otherData": {"title": "x"}}'])
def test_a_file_that_is_no_timeline_is_named_and_left_out(
    tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path, "broken.json", text)
    assert timelines.load(tmp_path) == []
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert "broken.json: skipped: not a timeline" in lines[0]
