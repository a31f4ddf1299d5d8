"""The verbs of the C++ program, as its `--help-all` and its `--help` tell of them."""

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

from docs.generate.markdown import code

TOLD_FROM = 30
"""The column of the help in which meanings begin."""

OF_THE_MACHINE = ("--threads", "THREADS")
"""What has the machine's processors as its default, which is another number on another machine."""


@dataclass(frozen=True)
class Row:
    """An argument or an option: what is typed, what holds without it (as Markdown), what it means."""

    typed: str
    default: str
    told: str


@dataclass(frozen=True)
class Verb:
    """A verb with its arguments and options. `end` is what its help says last."""

    name: str
    told: str
    usages: tuple[str, ...]
    rows: tuple[Row, ...]
    end: str = ""


def help_of(program: Path, option: str) -> str:
    """What the program prints. Raises CalledProcessError where it cannot."""
    done = subprocess.run([program, option], capture_output=True, text=True, check=True)
    return done.stdout


def groups(text: str) -> dict[str, list[str]]:
    """The names of verbs by the group that `carom --help` lists them in."""
    found: dict[str, list[str]] = {}
    group = ""
    for line in text.splitlines():
        if heading := re.fullmatch(r"([A-Z].*):", line):
            group = heading[1]
        elif group != "Options" and (verb := re.match(r"  ([a-z]+)(  |$)", line)):
            found.setdefault(group, []).append(verb[1])
    return found


def ending(text: str) -> str:
    """What `carom --help` says below the verbs: its exit codes."""
    return " ".join(text[text.index("Exit codes:") :].split())


def verbs(text: str) -> dict[str, Verb]:
    """All verbs of `carom --help-all`, those too that only a study calls, by name."""
    found = {}
    for part in re.split(r"\n\n(?=[^\n]*(?:\n[^\n]+)*\nUsage: carom )", text)[1:]:
        told, _, rest = part.partition("\nUsage: ")
        usage, *lines = rest.splitlines()
        name = usage.split()[1]
        found[name] = Verb(name, " ".join(told.split()), (usage,), tuple(_rows(lines)))
    return found


def _rows(lines: list[str]) -> Iterator[Row]:
    """The entries below `Arguments:` and `Options:`; what each verb has is left out."""
    entries: list[list[str]] = []
    for line in takewhile(lambda line: not line.startswith("Exit codes:"), lines):
        if re.match(r"  \S", line):
            is_on_one_line = line[TOLD_FROM - 2 : TOLD_FROM] == "  "
            typed = line[:TOLD_FROM] if is_on_one_line else line
            entries.append([typed.strip(), line[len(typed) :].strip()])
        elif entries and line.startswith(" " * TOLD_FROM):
            entries[-1].append(line.strip())
    for typed, *told in entries:
        if not typed.startswith(("-h,", "--help-all")):
            form, default = _with_default(typed)
            yield Row(form, default, " ".join(filter(None, told)))


def _with_default(typed: str) -> tuple[str, str]:
    form, _, default = typed.partition("=")
    is_of_machine = default.isdigit() and form.split()[0] in OF_THE_MACHINE
    return form, "as many as the machine gives" if is_of_machine else code(default)
