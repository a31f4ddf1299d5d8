"""Whether a file holds a record that can be counted, and what is wrong if it does not."""

import contextlib
import json
from typing import Any

from jsonschema.exceptions import best_match

from support.files import finite, of_json
from support.record_schema import definition, is_record

NEEDED_TAGS = ["experiment", "series", "x_name", "x", "block"]
NUMERIC_TAGS = ["x", "block"]
TEXT_TAGS = ["experiment"]


def checked(content: bytes, failures: bool) -> tuple[str | None, dict[str, Any]]:
    """Return what is wrong with the content of a file in the folder of failures or of records, or None and
    the record.
    """
    with contextlib.suppress(ValueError):
        return _checked(of_json(content), failures)
    try:  # more slowly, for what is to be said of it
        return _checked(json.loads(content, parse_float=finite, parse_constant=finite), failures)
    except UnicodeDecodeError:
        return "not UTF-8 text", {}
    except json.JSONDecodeError as error:
        return f"not JSON (line {error.lineno}, column {error.colno}: {error.msg})", {}
    except ValueError as error:
        return f"not JSON ({error})", {}
    except RecursionError:
        return "not a Carom record (nested too deeply)", {}


def _checked(record: Any, failures: bool) -> tuple[str | None, dict[str, Any]]:  # noqa: ANN401 - any JSON
    if not isinstance(record, dict) or "schema_version" not in record:
        return "not a Carom record (no schema_version)", {}
    expected = definition().schema["properties"]["schema_version"]["const"]  # type: ignore[index]
    if record["schema_version"] != expected:
        return f"schema version {record['schema_version']!r}, expected {expected}", {}
    if not is_record(record):
        violation = best_match(definition().iter_errors(record))
        told = (
            f"{violation.json_path}: {_shortened(violation.message)}" if violation else "not a Carom record"
        )
        return told, {}
    return _wrong_tag(record, failures), record


def _shortened(message: str, limit: int = 160) -> str:
    line = " ".join(message.split())
    return line if len(line) <= limit else f"{line[: limit // 2]} ... {line[-limit // 2 :]}"


def _wrong_tag(record: dict[str, Any], failures: bool) -> str | None:
    if failures != (record["kind"] == "failure"):
        return f"a record of kind {record['kind']!r} in the wrong folder"
    tags = record["tags"]
    if record["kind"] == "limits":
        return None
    for name in NEEDED_TAGS[:1] if failures else NEEDED_TAGS:
        if name not in tags:
            return f"$.tags.{name}: missing"
        if name in NUMERIC_TAGS and isinstance(tags[name], str):
            return f"$.tags.{name}: found {tags[name]!r}, expected a number"
        if name in TEXT_TAGS and not isinstance(tags[name], str):
            return f"$.tags.{name}: found {tags[name]!r}, expected a text"
    return None
