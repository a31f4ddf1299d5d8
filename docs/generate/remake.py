"""Makes figures again: runs their commands, copies what they leave, and writes anew of what they are."""

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Any

from docs.generate import sources
from docs.generate.figures import TABLE, Figure
from support.errors import InputError
from support.files import write_text
from support.home import ROOT

MEASURED = ("kernels", "variants", "harness", "experiments", "analysis", "support")
Origin = tuple[str, date, str]
"""Commit, date and machine."""


def make(
    figures: Sequence[Figure],
    root: Path = ROOT,
    table: Path = TABLE,
    are_committed: Callable[[Path], bool] = lambda root: (
        not _git(root, "status", "--porcelain", "--", *MEASURED)
    ),
) -> int:
    """Make them one after another; returns 0, or 2 where one failed or is not whole. Raises InputError where
    sources have changes that no commit tells of, since a figure could not say of what it is.
    """
    if figures and not are_committed(root):
        raise InputError(f"{root}: has changes that are not committed, expected a commit to name")
    failed = [one.name for one in figures if not _is_made(one, root, table)]
    if failed:
        print(f"not made, or not as a whole: {', '.join(failed)}", file=sys.stderr)
    return 2 if failed else 0


def _is_made(figure: Figure, root: Path, table: Path) -> bool:
    """Make one. A study in which a point failed has drawn its figure, which is not whole."""
    takes = (
        "how long it takes is not known" if figure.minutes is None else f"about {figure.minutes:g} minutes"
    )
    print(f"{figure.name}: {takes}: {figure.command.strip()}", file=sys.stderr, flush=True)
    began = time.time()
    code = subprocess.call(["bash", "-euxo", "pipefail", "-c", figure.command], cwd=root)
    made = {file: root / path for file, path in figure.files.items()}
    missing = [path for path in made.values() if not path.is_file() or path.stat().st_mtime < began - 1]
    if missing or code not in (0, 2):
        print(f"{figure.name}: stays as it was: ended with exit code {code}", *missing, file=sys.stderr)
        return False
    for file, path in made.items():
        shutil.copyfile(path, root / file)
    record(table, figure, origin(root, figure.origin), sources.digest(root, figure.sources))
    if code:
        print(f"{figure.name}: made without points that failed, as said above", file=sys.stderr)
    return code == 0


def record(table: Path, figure: Figure, of: Origin, digest: str) -> None:
    """Write into the table of what the figure is now."""
    commit, measured, machine = of
    new = {
        key: json.dumps(one) for key, one in (("commit", commit), ("machine", machine), ("digest", digest))
    }
    new["measured"] = str(measured)
    text = table.read_text(encoding="utf-8")
    begin = text.index(f"[{figure.name}]\n")
    end = text.find("\n[", begin) % (len(text) + 1)
    lines = [
        f"{key} = {new[key]}" if (key := line.partition(" = ")[0]) in new else line
        for line in text[begin:end].splitlines()
        if not line.startswith("same = ")
    ]
    write_text(table, text[:begin] + "\n".join(lines) + (text[end:] or "\n"), table.parent)


def origin(root: Path, place: str) -> Origin:
    """What the records in a folder or the streams of a calibration say; without a place, this checkout today.
    Raises InputError where they say nothing.
    """
    path = root / place
    if not place:
        return _git(root, "rev-parse", "--short=7", "HEAD"), datetime.now(UTC).date(), _this_machine()
    if path.is_dir():
        newest = max(_records(path), key=lambda one: str(one["recorded_at"]), default=None)
        if newest is None:
            raise InputError(f"{path}: has no record, expected what the figure was drawn from")
        return _of_provenance(newest["provenance"], newest["recorded_at"])
    first = json.loads(path.read_text(encoding="utf-8"))["streams"][0]
    return _of_provenance(first["provenance"], first["began_at"])


def _records(folder: Path) -> list[dict[str, Any]]:
    contents = (json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.json")))
    return [one for one in contents if "provenance" in one and "recorded_at" in one]


def _of_provenance(provenance: Mapping[str, Any], at: str) -> Origin:
    commit = str(provenance.get("commit") or "")[:7]
    kind = "virtual machine" if provenance.get("virtualised") else "machine"
    cores = provenance.get("cores") or provenance.get("hardware_threads")
    machine = f"{kind} with {cores} cores ({provenance.get('cpu_model')})"
    return commit, date.fromisoformat(at[:10]), machine


def _this_machine() -> str:
    from experiments.plan.site import this_machine

    here = this_machine()
    return f"machine with {here.cores} cores ({here.name})"


def _git(root: Path, *words: str) -> str:
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=False)
    if done.returncode:
        raise InputError(f"git {words[0]}: {done.stderr.strip()}, expected a checkout")
    return done.stdout.strip()
