"""What the two pages that are made of a JSON schema have in common."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from docs.generate.markdown import with_large_letter

Schema = Mapping[str, Any]

TYPES = {
    "object": "object",
    "array": "list",
    "string": "text",
    "integer": "whole number",
    "number": "number",
    "boolean": "true or false",
    "null": "null",
}


def read(path: Path) -> Schema:
    """A schema. Raises OSError and ValueError."""
    schema: Schema = json.loads(path.read_text(encoding="utf-8"))
    return schema


def definition(schema: Schema, node: Schema) -> tuple[str, Schema]:
    """Name and content of the definition that a node refers to; no name and the node itself if to none."""
    name = str(node["$ref"]).rpartition("/")[2] if "$ref" in node else ""
    return name, schema["$defs"][name] if name else node


def type_of(schema: Schema, node: Schema) -> str:
    """The type in words; a definition that is no mere list or number is linked to."""
    name, node = definition(schema, node)
    if name and ("properties" in node or "if" in node):
        return f"[{name}](#{name})"
    if "const" in node:
        return _value(node["const"])
    if "enum" in node:
        return ", ".join(map(_value, node["enum"]))
    if "anyOf" in node:
        return " or ".join(type_of(schema, one) for one in node["anyOf"])
    types = node.get("type", [])
    return " or ".join(_named(schema, node, one) for one in ([types] if isinstance(types, str) else types))


def _named(schema: Schema, node: Schema, name: str) -> str:
    if name == "array" and "items" in node:
        items = type_of(schema, node["items"])
        return f"list of {items}{'s' if items in TYPES.values() else ''}"
    return TYPES[name]


def _value(value: object) -> str:
    return f"`{value}`" if isinstance(value, str) else json.dumps(value)


def told(schema: Schema, node: Schema) -> str:
    """What a node means: its own description, or that of its definition."""
    text = node.get("description") or definition(schema, node)[1].get("description", "")
    return with_large_letter(text)
