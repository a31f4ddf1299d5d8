"""The graphs of the published report: what each showed, and where it is measured and drawn again."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.figures import titles
from analysis.support.values import rows_in


@dataclass(frozen=True)
class Graph:
    """A published graph, what it showed, and the questions that measure it again, the one drawn first;
    `appendix` tells those of the published appendix.
    """

    name: str
    showed: str
    questions: Sequence[str]
    appendix: bool = False


def load() -> list[Graph]:
    """Return the published graphs, in the order of the published report."""
    return rows_in(Path(__file__).with_name("graphs.toml"), "graph", Graph)


def rows(anchors: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return a row a graph for the report, its questions with their titles and, if any, their `anchors`."""
    known = titles()
    return [
        {
            **vars(graph),
            "questions": [
                {"name": name, "title": known[name], "anchor": anchors.get(name)} for name in graph.questions
            ],
        }
        for graph in load()
    ]
