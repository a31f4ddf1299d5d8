"""The digest of the sources that a figure depends on: of what they do, not of how they are written.

Of C++ and Python no comment, no empty space and no include counts, of Python no docstring, of TOML and JSON
neither their layout. Where a file is and what it is called does not count either.
"""

import hashlib
import io
import json
import re
import tokenize
import tomllib
from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path

from support.errors import InputError

_CPP = re.compile(
    r"""(?P<left_out>//[^\n]*|/\*.*?\*/|^[ \t]*\#[ \t]*include\b[^\n]*)
    |R"(?P<end>[^(\s"]*)\(.*?\)(?P=end)"
    |"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'
    |\.?\d(?:[eEpP][+-]|'\w|[\w.])*|\w+|\S""",
    re.DOTALL | re.VERBOSE | re.MULTILINE,
)
DIGITS = 16
ENDS = (tokenize.NEWLINE, tokenize.COMMENT)
"""Of a statement."""


def digest(root: Path, patterns: Iterable[str]) -> str:
    """The digest of all files that the patterns match. Raises InputError where one matches none."""
    parts = {path: hashlib.sha256(meaning(path).encode()).hexdigest() for path in files(root, patterns)}
    return hashlib.sha256("\n".join(sorted(parts.values())).encode()).hexdigest()[:DIGITS]


def files(root: Path, patterns: Iterable[str]) -> set[Path]:
    """The files that the patterns match. Raises InputError where one matches none."""
    found = set()
    for pattern in patterns:
        matched = [path for path in root.glob(pattern) if path.is_file()]
        if not matched:
            raise InputError(f"{pattern}: matches no file, expected sources of a figure")
        found.update(matched)
    return found


def meaning(path: Path) -> str:
    """The content of a file without what changes nothing that it does."""
    text = path.read_text(encoding="utf-8")
    match path.suffix:
        case ".hpp" | ".cpp":
            return "\0".join(one.group() for one in _CPP.finditer(text) if one["left_out"] is None)
        case ".py":
            return "\n".join(_python_lines(text))
        case ".toml":
            return json.dumps(tomllib.loads(text), sort_keys=True, default=str)
        case ".json":
            return json.dumps(json.loads(text), sort_keys=True)
        case _:
            return text


def _python_lines(text: str) -> Iterator[str]:
    """The lines that are left when comments and texts that stand by themselves are taken out."""
    lines = text.splitlines()
    for (first, begin), (last, end) in sorted(_left_out(text), reverse=True):
        head, tail = lines[first - 1][:begin], lines[last - 1][end:]
        lines[first - 1 : last] = [head + tail] + [""] * (last - first)
    yield from (line.rstrip() for line in lines if line.strip())


Span = tuple[tuple[int, int], tuple[int, int]]


def _left_out(text: str) -> Iterator[Span]:
    """Where comments stand, and texts that are a statement of their own."""
    begins = True
    for one, after in pairwise(tokenize.generate_tokens(io.StringIO(text).readline)):
        is_lone = begins and one.type == tokenize.STRING and after.type in ENDS
        if is_lone or one.type == tokenize.COMMENT:
            yield one.start, one.end
        if one.type not in (tokenize.COMMENT, tokenize.NL):
            begins = one.type in (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
