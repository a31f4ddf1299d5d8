"""The page of a question's keys: from the schema that checks them and the classes that they are read into."""

from collections.abc import Iterator
from dataclasses import MISSING, fields

from docs.generate.markdown import code, page, table
from docs.generate.schema import Schema, definition, read, told, type_of
from experiments.plan.kinds import KINDS
from experiments.plan.question import FOLDER, Blocks, Question, Sweep
from experiments.plan.scenes import HardCase, Scene
from experiments.plan.series import Benchmark, PrintedTime, Series

OPENING = (
    "A question is a TOML file. `carom study new NAME` writes one to start from. "
    "A mistake in it is answered with the file, the key, what was found and what was expected."
)
READ_INTO: dict[str, type] = {
    "": Question, "generated": Scene, "case": HardCase, "sweep": Sweep, "blocks": Blocks, "series": Series,
    "time": PrintedTime, "benchmark": Benchmark,
}  # fmt: skip
TITLES = {
    "": "At the top",
    "generated": "A scene: `[scene]`, `[[scenes]]`",
    "case": "A scene that is a hard case",
    "sweep": "What changes along a curve: `[sweep]`",
    "blocks": "How often: `[blocks]`",
    "series": "A curve: `[[series]]`",
    "time": "`time` of a series",
    "benchmark": "`benchmark` of a series",
}
NO_DEFAULT = ("kind", "figure", "verb", "reference", "x_name", "values", "quick_values", "exit_codes")
"""Keys of which the schema says what holds without them, or that others fill in."""


def render() -> str:
    """The page."""
    schema = read(FOLDER / "question.schema.json")
    return page("Keys of a question", OPENING, *_sections(schema), _kinds())


def _sections(schema: Schema) -> Iterator[str]:
    series = schema["$defs"]["series"]["properties"]
    nodes = {"": schema, **schema["$defs"], "time": series["time"], "benchmark": series["benchmark"]}
    for name, title in TITLES.items():
        head = ("key", "type", "default", "meaning")
        yield f"## {title}\n\n" + table(head, _rows(schema, nodes[name], READ_INTO[name]))


def _rows(schema: Schema, node: Schema, read_into: type) -> Iterator[tuple[str, ...]]:
    defaults = {one.name: one.default for one in fields(read_into) if one.default is not MISSING}
    for key, value in node["properties"].items():
        default = "required" if key in node.get("required", ()) else _default(defaults.get(key), key)
        yield code(key), _type(schema, value), default, told(schema, value)


def _type(schema: Schema, node: Schema) -> str:
    """In words; tables have sections of their own, named otherwise than in the schema."""
    name, content = definition(schema, node)
    if name == "scene" or content.get("type") == "object":
        return "table"
    if content.get("type") == "array" and "$ref" in content["items"]:
        return "list of tables"
    return type_of(schema, content)


def _default(value: object, key: str) -> str:
    if key in NO_DEFAULT or not isinstance(value, (str, int, float)):
        return ""
    return code(str(value).lower() if isinstance(value, bool) else str(value))


def _kinds() -> str:
    """What each kind of question is."""
    rows = [
        (code(name), kind.measured, kind.judged, ", ".join(map(code, kind.figures)), *_wants(name))
        for name, kind in KINDS.items()
    ]
    head = ("kind", "what is measured", "how it is judged", "figures, the usual one first", "needs")
    return "## Kinds of questions\n\n" + table(head, rows)


def _wants(name: str) -> tuple[str]:
    kind = KINDS[name]
    wanted = ["`errors = true`"] if kind.errors else []
    wanted += [f"a sweep of {code(kind.sweep)}"] if kind.sweep else []
    return ("; ".join(wanted),)
