"""The generated pages are what their generators make now; their generators read help, parsers and schemas."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from documents import BUILT

from docs.generate import command_line, pages, program_help, python_verbs, schema
from experiments.plan.question import FOLDER, Blocks, Question, Sweep
from experiments.plan.scenes import HardCase, Scene
from experiments.plan.series import SECONDS_OF_UNIT, Series
from support.record_schema import SCHEMA_FILE


@pytest.mark.parametrize("name", [name for name in pages.PAGES if name != "command_line.md"])
def test_a_page_is_what_its_generator_makes(name: str) -> None:
    made = pages.PAGES[name]()
    assert (pages.FOLDER / name).read_text(encoding="utf-8") == made, f"{name}: `make docs` makes it anew"


@pytest.mark.skipif(not BUILT, reason="build/gcc/carom is not built (`make build` builds it)")
def test_the_page_of_the_command_line_is_what_its_generator_makes() -> None:
    page = pages.FOLDER / "command_line.md"
    assert page.read_text(encoding="utf-8") == command_line.render(pages.PROGRAM), "`make docs` makes it anew"


@pytest.mark.skipif(not BUILT, reason="build/gcc/carom is not built (`make build` builds it)")
def test_every_verb_is_on_the_page() -> None:
    page = (pages.FOLDER / "command_line.md").read_text(encoding="utf-8")
    listed = program_help.groups(program_help.help_of(pages.PROGRAM, "--help"))
    for name in (one for names in listed.values() for one in names if one != "study"):
        assert f"\n### carom {name}\n" in page
    for name in python_verbs.study_verbs():
        assert f"\n### carom {name}\n" in page


@pytest.mark.parametrize("file", [SCHEMA_FILE, FOLDER / "question.schema.json"], ids=lambda file: file.name)
def test_every_field_of_a_schema_says_what_it_means(file: Path) -> None:
    content = schema.read(file)
    silent = [path for path, node in _fields(content, "") if not schema.told(content, node)]
    assert silent == []


READ_INTO: dict[str, type] = {
    "": Question, "generated": Scene, "case": HardCase, "sweep": Sweep, "blocks": Blocks, "series": Series,
}  # fmt: skip
FILLED_IN = {"verb", "x_name", "minimum", "wanted"}
"""Keys that the reader fills in, or that no table may lack."""


@pytest.mark.parametrize("name", READ_INTO)
def test_the_defaults_of_a_question_are_those_of_what_it_is_read_into(name: str) -> None:
    content = schema.read(FOLDER / "question.schema.json")
    node = content["$defs"][name] if name else content
    said = {key: one["default"] for key, one in node["properties"].items() if "default" in one}
    plain = {
        one.name: one.default for one in fields(READ_INTO[name]) if isinstance(one.default, str | int | float)
    }
    assert said == {key: one for key, one in plain.items() if key in node["properties"].keys() - FILLED_IN}
    unit = content["$defs"]["time"]["properties"]["unit"]["default"]
    assert SECONDS_OF_UNIT[unit] == Series.unit_seconds


def _fields(node: Mapping[str, Any], prefix: str) -> list[tuple[str, Mapping[str, Any]]]:
    """All fields that a schema defines, with where they stand."""
    found = []
    for name, one in node.get("properties", {}).items():
        found += [(f"{prefix}{name}", one), *_fields(one.get("items", one), f"{prefix}{name}.")]
    for rule in node.get("allOf", ()):
        found += _fields(rule["then"], prefix)
    for name, one in node.get("$defs", {}).items():
        found += _fields(one, f"{prefix}${name}.")
    return found
