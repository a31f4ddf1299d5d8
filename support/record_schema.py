"""What a record is, by `harness/record.schema.json`."""

import json
from functools import cache
from typing import Any

import jsonschema
import jsonschema_rs

from support.home import ROOT

SCHEMA_FILE = ROOT / "harness" / "record.schema.json"

VERSION = 2
"""Of the schema."""


def refusal(content: object) -> str | None:
    """Why the content of a file is no record of this version, with what to do about one of another."""
    if not isinstance(content, dict) or "schema_version" not in content:
        return "not a Carom record (no schema_version)"
    version = content["schema_version"]
    if version == VERSION:
        return None
    return (
        f"schema version {version!r}, expected {VERSION}: measure it again, "
        "or read it with the release of Carom that wrote it"
    )


def is_record(content: object) -> bool:
    """Whether the content of a file is a record of any kind."""
    try:
        return _quick_validator().is_valid(content)
    except (ValueError, RecursionError):
        return False  # nested too deeply, or nothing that JSON can hold


@cache
def definition() -> jsonschema.Draft202012Validator:
    """The validator that says what is wrong with a record."""
    return jsonschema.Draft202012Validator(_schema())


@cache
def _quick_validator() -> jsonschema_rs.Draft202012Validator:
    """The one that says only whether anything is wrong, a hundred times as fast: nearly no record is."""
    return jsonschema_rs.Draft202012Validator(_schema())


@cache
def _schema() -> Any:  # noqa: ANN401 - JSON is any value
    return json.loads(SCHEMA_FILE.read_text(encoding="utf-8"))
