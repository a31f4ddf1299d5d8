"""The page of a record's fields, from the schema that each record is checked against."""

from collections.abc import Iterator

from docs.generate.markdown import code, page, sentence, table
from docs.generate.schema import Schema, definition, read, told, type_of
from support.record_schema import SCHEMA_FILE

OPENING = (
    "A record is a JSON file: one measured process with all that were compared in it, its contenders. It is "
    "written once and never edited. A value that was not measured is null, and a field beside it says why. "
    "A field whose type stands in brackets may be absent."
)
UNITS = {"seconds": "s", "bytes": "B"}
HEAD = ("field", "type", "unit", "meaning")


def render() -> str:
    """The page."""
    schema = read(SCHEMA_FILE)
    common = f"## Every record\n\n{table(HEAD, _rows(schema, schema))}"
    named = [
        f"## {name}\n\n{sentence(told(schema, node))}\n\n{table(HEAD, _rows(schema, node))}"
        for name, node in schema["$defs"].items()
        if "properties" in node
    ]
    return page("Fields of a record", OPENING, common, *named)


def _rows(schema: Schema, node: Schema, prefix: str = "") -> Iterator[tuple[str, ...]]:
    """A row a field, and rows for the fields within it if they are defined there and nowhere else."""
    for name, field in node["properties"].items():
        shown = f"{prefix}{name}"
        typed = type_of(schema, field)
        typed = typed if name in node.get("required", ()) else f"({typed})"
        yield code(shown), typed, _unit(schema, name, field), told(schema, field)
        inner = field.get("items", field)
        if "properties" in inner:
            yield from _rows(schema, inner, f"{shown}{'[]' if 'items' in field else ''}.")


def _unit(schema: Schema, name: str, field: Schema) -> str:
    """As the schema says, or else the name."""
    if "unit" in field:
        return str(field["unit"])
    if definition(schema, field)[0]:
        return ""
    return next((unit for word, unit in UNITS.items() if word in name.split("_")), "")
