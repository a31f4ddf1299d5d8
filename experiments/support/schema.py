"""TOML files checked against a JSON Schema, with one line for the first thing that is wrong."""

import json
import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
from jsonschema.exceptions import ValidationError

from support.errors import InputError, nearest
from support.files import finite

_TYPES = {
    "object": "a table",
    "array": "a list",
    "string": "a text",
    "integer": "a whole number",
    "number": "a number",
    "boolean": "true or false",
}


@cache
def validator(path: Path) -> jsonschema.Draft202012Validator:
    """The compiled validator of a schema file."""
    return jsonschema.Draft202012Validator(json.loads(path.read_text(encoding="utf-8")))


def read_toml(path: Path, schema: Path) -> dict[str, Any]:
    """Read `path` and check it against `schema`, a file.

    Raises InputError with one line: file, key, what was found, what was expected, the nearest valid name.
    """
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=finite)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text at byte {error.start}") from error
    except ValueError as error:
        raise InputError(f"{path}: is not valid TOML: {error}") from error
    except RecursionError as error:
        raise InputError(f"{path}: is not valid TOML: nested too deeply") from error
    errors = validator(schema).iter_errors(document)
    first = min(errors, key=lambda error: (len(error.absolute_path), str(error.json_path)), default=None)
    if first is not None:
        raise InputError(f"{path}: {_line(first)}")
    return document


def _line(error: ValidationError) -> str:
    key = _key(error)
    found: Any = error.instance
    schema: Any = error.schema
    rule: Any = error.validator_value
    known = list(schema.get("properties", {}))
    if error.validator == "additionalProperties":
        unknown = next(name for name in found if name not in known)
        told = f"unknown key; expected one of {', '.join(known)}{nearest(unknown, known)}"
        return f"{_below(key, unknown)}: {told}"
    if error.validator == "required":
        missing = next(name for name in rule if name not in found)
        expected = _expected(schema.get("properties", {}).get(missing, {"type": "string"}))
        return f"{_below(key, missing)}: missing; expected {expected}"
    hint = nearest(str(found), map(str, schema.get("enum", ())))
    value = json.dumps(found, default=str, ensure_ascii=False)
    return f"{key}: found {value}, expected {_expected(schema)}{hint}"


def _below(key: str, name: str) -> str:
    shown = _shown(name)
    return f"{key}.{shown}" if key else shown


def _shown(name: str) -> str:
    """Return a key as TOML would write it: quoted where it would not stay on its line."""
    return name if name.isprintable() else json.dumps(name)


def _key(error: ValidationError) -> str:
    parts = (f"[{part + 1}]" if isinstance(part, int) else f".{_shown(part)}" for part in error.absolute_path)
    return "".join(parts).lstrip(".")


def _expected(schema: Mapping[str, Any]) -> str:
    if "expected" in schema:
        return str(schema["expected"])
    if "enum" in schema:
        return "one of " + ", ".join(str(value) for value in schema["enum"])
    text = _TYPES.get(schema.get("type", ""), "another value")
    for key, told in (("minimum", "of at least"), ("maximum", "and at most"), ("exclusiveMinimum", "above")):
        text += f" {told} {schema[key]}" if key in schema else ""
    if schema.get("minLength") or schema.get("minItems") or schema.get("minProperties"):
        text += " that is not empty"
    if schema.get("uniqueItems"):
        text += ", each value once"
    return text
