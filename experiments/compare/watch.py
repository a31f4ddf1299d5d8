"""What the first runs start and load, whatever lies between: a Google Benchmark, and shared libraries."""

import contextlib
import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from experiments.compare.commands import words_in
from experiments.compare.options import Asked

_LOADED = re.compile(r"calling init: (.+)")
"""What the loader writes of a library, also of one that a running program opens (ld.so(8), LD_DEBUG)."""
_EXECUTABLE = re.compile(r'"executable": "((?:[^"\\]|\\.)+)"')
"""In the report of a Google Benchmark, the program that wrote it."""

_OTHER_ROOTS = frozenset(("chroot", "bwrap", "unshare", "nsenter", "firejail", "systemd-nspawn"))
"""Where a report could not be written, a Google Benchmark would fail."""

Require = Callable[[Sequence[Path]], None]
"""Raises NotMeantError for a library that nobody meant to be loaded."""


class Watch:
    """Asks by variables of the environment, which all that is started hands on. A variable that the user has
    set stays, and what knows none of them says nothing.
    """

    def __init__(self, folder: Path, require: Require = lambda _: None) -> None:
        """In a folder of this process, which programs of other users have to reach as well."""
        self.require = require
        self.folder = folder / "watched"
        self.folder.mkdir()
        folder.chmod(0o711)
        self.folder.chmod(0o777)
        self._report = self.folder / "benchmark.json"
        self._report.touch()
        self._report.chmod(0o666)

    @contextlib.contextmanager
    def watching(self, asked: Asked) -> Iterator[None]:
        """Watch what is started inside, with a look for Google Benchmarks where none is meant."""
        loader = {"LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(self.folder / "loaded")}
        words = {part for one in asked.commands for word in one.words for part in (word, *words_in(word))}
        is_open = not (asked.is_whole or asked.cases or words & _OTHER_ROOTS)
        wanted = {**loader, **({"BENCHMARK_OUT": str(self._report)} if is_open else {})}
        own = {name: value for name, value in wanted.items() if name not in os.environ}
        os.environ.update(own)
        try:
            yield
        finally:
            for name in own:
                del os.environ[name]

    @property
    def benchmark(self) -> str | None:
        """The Google Benchmark that ran, if one did."""
        found = _EXECUTABLE.search(self._report.read_text(encoding="utf-8", errors="replace"))
        return found and found[1]

    def loaded(self, folders: Sequence[Path]) -> list[Path]:
        """The shared libraries that were loaded, each once, by programs that run in these folders."""
        named = {
            found[1]
            for file in self.folder.glob("loaded.*")
            for found in _LOADED.finditer(file.read_text(encoding="utf-8", errors="replace"))
        }
        paths = {(folder / name).resolve() for name in named for folder in folders}
        return sorted(path for path in paths if path.is_file())
