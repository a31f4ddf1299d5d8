"""The blocks of the documents that a reader would type in or write to a file."""

import os
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
BUILT = (ROOT / "build" / "gcc" / "carom").is_file()
DOCUMENTS = sorted(
    path.relative_to(ROOT).as_posix()
    for pattern in ("*.md", "docs/*.md", "docs/reference/*.md", "experiments/*.md", "analysis/*.md")
    for path in ROOT.glob(pattern)
)
KINDS = ("", "slow", "fresh", "verbs")
"""Of shell blocks: run by `make test`; by `make test-all`, after the quick ones; on a fresh machine; only
looked at, since they need a cluster, or are the tests themselves."""


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, the word behind it, its text, and the line that it begins on."""

    language: str
    word: str
    text: str
    line: int


def blocks(text: str) -> Iterator[Block]:
    """The fenced blocks of a document, in order."""
    for found in re.finditer(r"^```(\w*) ?(\S*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        line = text.count("\n", 0, found.start()) + 1
        yield Block(found[1], found[2], found[3], line)


def document(name: str) -> list[Block]:
    """The blocks of one of the project's documents."""
    return list(blocks((ROOT / name).read_text(encoding="utf-8")))


def shell(name: str, kind: str) -> list[Block]:
    """A document's shell blocks of one kind."""
    return [block for block in document(name) if block.language == "sh" and block.word == kind]


def write_file(block: Block, folder: Path) -> None:
    """Do what a block tells that has a file's name behind its language: write the file, or change its lines.

    Raises ValueError for a change whose old lines do not stand in the file just once.
    """
    path = folder / block.word
    if block.language != "diff":
        path.write_text(block.text, encoding="utf-8")
        return
    lines = block.text.splitlines(keepends=True)
    old, new = ("".join(line[1:] for line in lines if line[0] in signs) for signs in ("- ", "+ "))
    text = path.read_text(encoding="utf-8")
    if text.count(old) != 1:
        raise ValueError(f"{block.word}: holds {text.count(old)} times what is to be replaced: {old}")
    path.write_text(text.replace(old, new), encoding="utf-8")


def output_of(script: str, folder: Path) -> str:
    """What a script prints that is run as a reader would, who has the program on the path."""
    left_out = ("MAKE", "OMP_", "PYTEST")
    settings = {key: value for key, value in os.environ.items() if not key.startswith(left_out)}
    # More threads than idle processors must not spin for each other.
    settings["OMP_WAIT_POLICY"] = "passive"
    settings["PATH"] = f"{folder / 'build' / 'gcc'}{os.pathsep}{settings['PATH']}"
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=folder, env=settings, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, errors="replace", check=False,
    )  # fmt: skip
    assert done.returncode == 0, f"exit code {done.returncode}\n{script}\n{done.stdout[-4000:]}"
    return done.stdout
