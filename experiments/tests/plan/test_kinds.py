"""The table of kinds: what a question is about, and how it is drawn where the file does not say."""

import json

import pytest

from experiments.plan.kinds import KINDS
from experiments.plan.plan import plan
from experiments.plan.question import FOLDER, load_question
from experiments.tests.conftest import CHUNKS, Workplace
from experiments.tests.plan.test_plan import surroundings
from support.vocabulary import COUNTS


def tags_of(place: Workplace, head: str) -> tuple[object, object]:
    path = place.question("chunks", CHUNKS.replace('figure = "schedule"', head))
    tags = plan(load_question(path), surroundings(place)).points[0].tags
    return tags["kind"], tags["figure"]


@pytest.mark.parametrize(
    ("head", "told"),
    [
        ('figure = "trend"', ("trend", "trend")),
        ('kind = "trend"', ("trend", "trend")),
        ('kind = "control"', ("control", "control")),
        ('kind = "comparison"\nfigure = "trend"', ("comparison", "trend")),
        ('kind = "trend"\nfigure = "comparison"', ("trend", "comparison")),
    ],
)
def test_a_figure_alone_stands_for_its_kind_and_a_kind_has_a_usual_figure(
    workplace: Workplace, head: str, told: tuple[str, str]
) -> None:
    assert tags_of(workplace, head) == told


def test_every_kind_can_be_asked_for_and_its_usual_figure_is_its_own() -> None:
    schema = json.loads((FOLDER / "question.schema.json").read_text(encoding="utf-8"))["properties"]
    assert set(schema["kind"]["enum"]) == {*schema["figure"]["enum"], COUNTS} == set(KINDS)
    for name, kind in KINDS.items():
        assert kind.figures[0] == ("comparison" if name == COUNTS else name)
        assert set(kind.figures) <= set(KINDS)
