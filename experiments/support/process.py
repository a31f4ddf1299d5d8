"""Child processes: they never outlive this one, and never go on beyond their time."""

import contextlib
import ctypes
import os
import select
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from experiments.support.descendants import adopt_orphans, children, end_all_but, hear_of_ends
from experiments.support.pipes import READ_BYTES, Allowance, Kept, drain, line

_PR_SET_PDEATHSIG = 1
_PRCTL = ctypes.CDLL(None, use_errno=True).prctl

TIMED_OUT = 124
NOT_FOUND = 127

_LONGEST_REASON = 500
_LONGEST_PAUSE = 0.05


@dataclass(frozen=True)
class Completed:
    """How a child ended; a negative exit code is the signal that killed it. Of output and error the end is
    kept, without the first `dropped` bytes of both.
    """

    command: tuple[str, ...]
    exit_code: int
    output: str
    error: str
    dropped: int = 0

    @property
    def reason(self) -> str:
        """In one line, why it failed."""
        if self.exit_code == TIMED_OUT:
            return self.error
        lines = [line.strip() for line in self.error.splitlines() if line.strip()]
        if len(lines) > 1 and lines[-1].startswith("Try '"):
            lines.pop()  # GNU's programs tell the reason before it
        said = lines[-1] if lines else ""
        said = said[-_LONGEST_REASON:]
        if self.exit_code < 0 and not said.startswith("killed by "):
            said = f"killed by {name_of_signal(-self.exit_code)}" + (f": {said}" if said else "")
        return said or f"exit code {self.exit_code} without a word"


def run(
    command: Sequence[str],
    environment: Mapping[str, str] | None = None,
    time_limit: float | None = None,
    folder: Path | None = None,
    *,
    ends_all: bool = True,
) -> Completed:
    """Run a command to its end, in a folder or where this process is, without a shell. Whatever ends this
    call early kills the child first; what it started ends with it, also what left its group, unless it is not
    to end `ends_all`.

    The time limit, in seconds, counts while this process runs: one that is stopped sees nothing of its child.
    It wakes up twice a second, so that nothing here takes the CPU from the process that is timed.
    """
    known = children()
    try:
        child = _start(command, environment, subprocess.DEVNULL, subprocess.PIPE, folder)
    except (OSError, ValueError) as error:
        said = error.strerror if isinstance(error, OSError) else error
        return Completed(tuple(command), NOT_FOUND, "", f"{command[0]}: cannot be run: {said}")
    output, errors, in_time = Kept(), Kept(), False
    with child:
        pipes = {_descriptor(child.stdout): output, _descriptor(child.stderr): errors}
        try:
            in_time = _follow(child, pipes, time_limit)
        except BaseException:
            ends_all = True
            raise
        finally:
            if ends_all or not in_time:
                _kill(child)
                end_all_but(known)
            child.wait()
    dropped = output.dropped + errors.dropped
    if not in_time:
        return Completed(tuple(command), TIMED_OUT, "", _took_longer(time_limit), dropped)
    return Completed(tuple(command), child.returncode, output.text, errors.text, dropped)


@contextlib.contextmanager
def alongside(command: Sequence[str]) -> Iterator[None]:
    """Let a command that prints nothing run until the block ends. It ends with this process, however that
    ends.
    """
    with _start(command, None, subprocess.DEVNULL, None) as child:
        try:
            yield
        finally:
            _kill(child)


class Coprocess:
    """A child that answers a line with a line, as often as asked, and sleeps in between; a context manager.

    It starts when first asked, and anew once it has ended.
    """

    def __init__(self, command: Sequence[str], environment: Mapping[str, str] | None = None) -> None:
        self._command = tuple(command)
        self._environment = environment
        self._child: subprocess.Popen[bytes] | None = None
        # A file: a pipe that nobody reads before the end could fill, and stop the child.
        self._errors = tempfile.TemporaryFile("w+", errors="replace")  # noqa: SIM115 - closed in __exit__

    def __enter__(self) -> "Coprocess":
        return self

    def __exit__(self, *_: object) -> None:
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
            self._child = _start(self._command, self._environment, subprocess.PIPE, self._errors)
        child = self._child
        assert child.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            child.stdin.write(f"{question}\n".encode())
            child.stdin.flush()
        answer = line(_descriptor(child.stdout), time_limit)
        if answer is None:
            self._end()
            return Completed(self._command, TIMED_OUT, "", _took_longer(time_limit))
        if answer:
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


def _follow(child: subprocess.Popen[bytes], pipes: dict[int, Kept], time_limit: float | None) -> bool:
    """Read what the child prints until it ends; whether it did so within its time.

    Its own end is what counts: who inherited its pipes may hold them open for as long as it likes.
    """
    allowance, open_pipes, pause = Allowance(time_limit), dict(pipes), 0.0005
    while True:
        if open_pipes:
            for pipe in select.select(list(open_pipes), [], [], allowance.step)[0]:
                if part := os.read(pipe, READ_BYTES):
                    open_pipes[pipe].add(part)
                else:
                    del open_pipes[pipe]
        else:
            time.sleep(min(pause, allowance.step))
            pause = min(2 * pause, _LONGEST_PAUSE)
        if _has_ended(child):
            for pipe, kept in open_pipes.items():
                drain(pipe, kept)
            return True
        if allowance.is_used_up():
            return False


def _start(
    command: Sequence[str],
    environment: Mapping[str, str] | None,
    stdin: int,
    stderr: int | IO[str] | None,
    folder: Path | None = None,
) -> subprocess.Popen[bytes]:
    hear_of_ends()
    adopt_orphans()
    return subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdin=stdin,
        stdout=subprocess.PIPE,
        stderr=stderr,
        start_new_session=True,  # Ctrl-C reaches this process alone, which then ends the child
        preexec_fn=_die_with_parent,  # safe: this process has no threads
    )


def _die_with_parent() -> None:
    """Ask the kernel to kill this child when its parent dies, even by SIGKILL."""
    _PRCTL(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _has_ended(child: subprocess.Popen[bytes]) -> bool:
    """Whether it has, without taking leave of it: until then nobody else gets its number. Raises where
    somebody else took leave of it, which Popen would take for a success.
    """
    return os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT | os.WNOHANG) is not None


def _kill(child: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()


def _descriptor(stream: IO[Any] | None) -> int:
    assert stream is not None
    return stream.fileno()


def _took_longer(time_limit: float | None) -> str:
    assert time_limit is not None
    return f"took longer than {time_limit:g} s and was stopped"


def name_of_signal(number: int) -> str:
    """The name of a signal; those of real time have none of their own."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
