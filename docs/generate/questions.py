"""The page of a question's keys: from the schema that checks them."""

from collections.abc import Iterator

from docs.generate.markdown import code, page, table
from docs.generate.schema import Schema, definition, read, told, type_of
from experiments.plan.kinds import KINDS, Kind
from experiments.plan.question import FOLDER

OPENING = (
    "A question is a TOML file. `carom study new NAME` writes one to start from. "
    "A mistake in it is answered with the file, the key, what was found and what was expected."
)


def render() -> str:
    """The page."""
    schema = read(FOLDER / "question.schema.json")
    sections = [
        f"## {node['section']}\n\n" + table(("key", "type", "default", "meaning"), _rows(schema, node))
        for node in (schema, *schema["$defs"].values())
        if "section" in node
    ]
    return page("Keys of a question", OPENING, *sections, _kinds())


def _rows(schema: Schema, node: Schema) -> Iterator[tuple[str, ...]]:
    for key, value in node["properties"].items():
        default = value.get("default", "")
        shown = code(str(default).lower() if isinstance(default, bool) else str(default))
        is_required = key in node.get("required", ())
        yield code(key), _type(schema, value), "required" if is_required else shown, told(schema, value)


def _type(schema: Schema, node: Schema) -> str:
    """In words; tables have sections of their own, named otherwise than in the schema."""
    name, content = definition(schema, node)
    if name == "scene" or content.get("type") == "object":
        return "table"
    if content.get("type") == "array" and "$ref" in content["items"]:
        return "list of tables"
    return type_of(schema, content)


def _kinds() -> str:
    """What each kind of question is."""
    rows = [
        (code(name), kind.measured, kind.judged, ", ".join(map(code, kind.figures)), _wants(kind))
        for name, kind in KINDS.items()
    ]
    head = ("kind", "what is measured", "how it is judged", "figures, the usual one first", "needs")
    return "## Kinds of questions\n\n" + table(head, rows)


def _wants(kind: Kind) -> str:
    errors, sweep = "`errors = true`" if kind.errors else "", f"a sweep of {code(kind.sweep or '')}"
    return "; ".join(filter(None, [errors, sweep if kind.sweep else ""]))
