"""Child processes: they never outlive this one, and never go on beyond their time."""

import contextlib
import ctypes
import os
import select
import signal
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO

_PR_SET_PDEATHSIG = 1
_PRCTL = ctypes.CDLL(None, use_errno=True).prctl

TIMED_OUT = 124
NOT_FOUND = 127


@dataclass(frozen=True)
class Completed:
    """How a child ended; a negative exit code is the signal that killed it."""

    command: tuple[str, ...]
    exit_code: int
    output: str
    error: str

    @property
    def reason(self) -> str:
        """In one line, why it failed."""
        if self.exit_code == TIMED_OUT:
            return self.error
        said = next((line.strip() for line in reversed(self.error.splitlines()) if line.strip()), "")
        if self.exit_code < 0:
            said = f"killed by {signal.Signals(-self.exit_code).name}" + (f": {said}" if said else "")
        return said or f"exit code {self.exit_code} without a word"


def run(
    command: Sequence[str],
    environment: Mapping[str, str] | None = None,
    time_limit: float | None = None,
    folder: Path | None = None,
) -> Completed:
    """Run a command to its end, in a folder or where this process is, without a shell. Whatever ends this
    call early kills the child first.

    `communicate` waits in the kernel, so that nothing here takes the CPU from the process that is timed.
    """
    try:
        child = _start(command, environment, subprocess.DEVNULL, subprocess.PIPE, folder)
    except OSError as error:
        return Completed(tuple(command), NOT_FOUND, "", f"{command[0]}: cannot be run: {error.strerror}")
    with child:
        try:
            output, said = child.communicate(timeout=time_limit)
        except subprocess.TimeoutExpired:
            _kill(child)
            said = f"took longer than {time_limit:g} s and was stopped"
            return Completed(tuple(command), TIMED_OUT, "", said)
        except BaseException:
            _kill(child)
            raise
    return Completed(tuple(command), child.returncode, output, said)


class Coprocess:
    """A child that answers a line with a line, as often as asked, and sleeps in between; a context manager.

    It starts when first asked, and anew once it has ended.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._command = tuple(command)
        self._child: subprocess.Popen[str] | None = None
        # A file: a pipe that nobody reads before the end could fill, and stop the child.
        self._errors = tempfile.TemporaryFile("w+", errors="replace")  # noqa: SIM115 - closed in __exit__

    def __enter__(self) -> "Coprocess":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()
        self._errors.close()

    def ask(self, question: str, time_limit: float) -> Completed:
        """Its answer to one line, with what it said on standard error meanwhile. A child that ends instead,
        or takes too long, has failed.
        """
        # The child sleeps, and goes on at the place in the file that is left here: they share it.
        self._errors.seek(0)
        self._errors.truncate()
        if self._child is None:
            self._child = _start(self._command, None, subprocess.PIPE, self._errors)
        child = self._child
        assert child.stdin is not None
        assert child.stdout is not None
        with contextlib.suppress(BrokenPipeError):
            print(question, file=child.stdin, flush=True)
        if not select.select([child.stdout], [], [], time_limit)[0]:
            self._end()
            said = f"took longer than {time_limit:g} s and was stopped"
            return Completed(self._command, TIMED_OUT, "", said)
        if answer := child.stdout.readline():
            return Completed(self._command, 0, answer, self._said())
        exit_code = child.wait()
        self._end()
        return Completed(self._command, exit_code or 1, "", self._said())

    def _said(self) -> str:
        self._errors.seek(0)
        return self._errors.read()

    def _end(self) -> None:
        if self._child is not None:
            _kill(self._child)
            with contextlib.suppress(BrokenPipeError), self._child:
                self._child = None


def _start(
    command: Sequence[str],
    environment: Mapping[str, str] | None,
    stdin: int,
    stderr: int | IO[str],
    folder: Path | None = None,
) -> subprocess.Popen[str]:
    return subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdin=stdin,
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
        errors="replace",
        start_new_session=True,  # Ctrl-C reaches this process alone, which then ends the child
        preexec_fn=_die_with_parent,  # safe: this process has no threads
    )


def _die_with_parent() -> None:
    """Ask the kernel to kill this child when its parent dies, even by SIGKILL."""
    _PRCTL(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _kill(child: subprocess.Popen[str]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()
