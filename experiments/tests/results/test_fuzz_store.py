"""A results folder with anything in it: what is no record is put aside, what is one still counts."""

import json
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from experiments.run.session import run
from experiments.run.status import rows
from experiments.run.study import Study
from experiments.tests.conftest import PAIR, Workplace
from experiments.tests.fake_carom import make_limits
from support.record_schema import is_record

NAMES = st.one_of(
    st.sampled_from(["x.json", "x-b0.json", "x-b².json", f"x-b{'9' * 5000}"[:200] + ".json", "-b1.json"]),
    st.from_regex(r"[a-z²٣ '\"-]{1,20}(-b[0-9²٣]{1,12})?\.json", fullmatch=True),
)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)
DEEP = st.sampled_from([300, 990, 3000, 100_000]).map(lambda depth: '{"tags":' * depth + "1" + "}" * depth)


@pytest.fixture
def measured(empty_workplace: Workplace) -> Workplace:
    empty_workplace.question("pair", PAIR)
    assert run(empty_workplace.settings) == 0
    return empty_workplace


@st.composite
def damaged(draw: st.DrawFn, record: dict[str, Any]) -> str:
    """A record of which one value, at any depth, is another; or anything else."""
    content = json.loads(json.dumps(record))
    place = content
    while isinstance(place, dict) and place:
        key = draw(st.sampled_from(sorted(place)))
        if not isinstance(place[key], dict) or draw(st.booleans()):
            place[key] = draw(JSON)
            break
        place = place[key]
    whole = json.dumps(content)
    torn = whole[: draw(st.integers(0, len(whole)))]
    return draw(st.one_of(st.just(torn), st.just(whole), DEEP, st.text()))


@given(st.data())
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_anything_in_a_results_folder_is_put_aside_or_counted_once(
    measured: Workplace, data: st.DataObject
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        results = Path(folder, "results")
        shutil.copytree(measured.results, results)
        *records, missing = sorted((results / "records" / "pair").rglob("*.json"))
        missing.unlink()  # so that something is left to be verified and measured
        damage = data.draw(damaged(json.loads(records[0].read_text(encoding="utf-8"))))
        victim = data.draw(st.sampled_from(["record", "new", "note"]))
        target = {
            "record": records[0],
            "new": records[0].with_name(data.draw(NAMES)),
            "note": data.draw(st.sampled_from([results / "plan.json", *(results / "checks").iterdir()])),
        }[victim]
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(damage, encoding="utf-8", errors="surrogatepass")
        place = replace(measured.settings, results=results)
        study = Study(place)
        (experiment,) = study.experiments
        with study.store.opened():
            found = study.store.settle(experiment)
        whole = {(point.id, 0) for point in experiment.points}
        harmed = victim == "record" and found.seconds.keys() != whole
        assert found.seconds.keys() == (set() if harmed else whole)
        assert not found.stale
        assert run(place) == 0
        (row,) = rows(study.store, [experiment])
        assert (row.done, row.missing, row.stale) == (4, 0, 0)


def test_a_record_of_another_kind_is_put_aside(measured: Workplace) -> None:
    [first, _] = measured.files("pair")
    bench = json.loads(first.read_text(encoding="utf-8"))
    limits = make_limits({"threads": "1", "tags": bench["contenders"][0]["tags"]})
    first.write_text(json.dumps(limits), encoding="utf-8")
    assert is_record(limits)
    study = Study(measured.settings)
    with study.store.opened():
        found = study.store.settle(study.experiments[0])
    assert {block for _, block in found.seconds} == {1}
    assert not first.exists()
    assert run(measured.settings) == 0
    assert measured.is_whole()
