"""Whether a file holds a record that can be counted, and what is wrong if it does not."""

import contextlib
import json
from typing import Any

from jsonschema.exceptions import best_match

from support.files import finite, of_json
from support.record_schema import definition, is_record, refusal

NEEDED_TAGS = ["experiment", "series", "x_name", "x", "block"]
"""Of whoever was measured; the first one of all that failed, too."""
NUMERIC_TAGS = ["x", "block"]
TEXT_TAGS = ["experiment"]


def checked(content: bytes) -> tuple[str | None, dict[str, Any]]:
    """Return what is wrong with the content of a file, or None and the record."""
    with contextlib.suppress(ValueError):
        return _checked(of_json(content))
    try:  # more slowly, for what is to be said of it
        return _checked(json.loads(content, parse_float=finite, parse_constant=finite))
    except UnicodeDecodeError:
        return "not UTF-8 text", {}
    except json.JSONDecodeError as error:
        return f"not JSON (line {error.lineno}, column {error.colno}: {error.msg})", {}
    except ValueError as error:
        return f"not JSON ({error})", {}
    except RecursionError:
        return "not a Carom record (nested too deeply)", {}


def _checked(record: Any) -> tuple[str | None, dict[str, Any]]:  # noqa: ANN401 - any JSON
    told = refusal(record)
    if told is None and not is_record(record):
        violation = best_match(definition().iter_errors(record))
        told = (
            f"{violation.json_path}: {_shortened(violation.message)}" if violation else "not a Carom record"
        )
    return (told, {}) if told else (_wrong_tag(record) or _wrong_turns(record), record)


def _shortened(message: str, limit: int = 160) -> str:
    line = " ".join(message.split())
    return line if len(line) <= limit else f"{line[: limit // 2]} ... {line[-limit // 2 :]}"


def _wrong_tag(record: dict[str, Any]) -> str | None:
    if record["kind"] == "limits":
        return None
    for number, contender in enumerate(record["contenders"]):
        tags, place = contender["tags"], f"$.contenders[{number}].tags"
        for name in NEEDED_TAGS[:1] if "reason" in contender else NEEDED_TAGS:
            if name not in tags:
                return f"{place}.{name}: missing"
            if name in NUMERIC_TAGS and isinstance(tags[name], str):
                return f"{place}.{name}: found {tags[name]!r}, expected a number"
            if name in TEXT_TAGS and not isinstance(tags[name], str):
                return f"{place}.{name}: found {tags[name]!r}, expected a text"
    return None


def _wrong_turns(record: dict[str, Any]) -> str | None:
    """Say what is wrong where not everybody has a turn in each round, or not each turn a time."""
    turns, count = record.get("turns") or {}, len(record["contenders"])
    if "rounds" not in turns:
        return None
    whose = turns["contenders"]
    rounds = [sorted(whose[first : first + count]) for first in range(0, len(whose), count)]
    if len(rounds) % turns["rounds"] or any(one != [*range(count)] for one in rounds):
        return f"$.turns.contenders: expected rounds with a turn of each of {count}, {turns['rounds']} a run"
    for name in ("steps", "seconds", "returning_seconds"):
        if len(turns[name]) != len(whose):
            return f"$.turns.{name}: found {len(turns[name])}, expected one for each of {len(whose)} turns"
    return None
