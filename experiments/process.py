"""One child process: it never outlives this one, and never goes on beyond its time."""

import contextlib
import ctypes
import os
import signal
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

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
    command: Sequence[str], environment: Mapping[str, str] | None = None, time_limit: float | None = None
) -> Completed:
    """Run a command to its end, without a shell. Whatever ends this call early kills the child first.

    `communicate` waits in the kernel, so that nothing here takes the CPU from the process that is timed.
    """
    try:
        child = subprocess.Popen(
            command,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            start_new_session=True,  # Ctrl-C reaches this process alone, which then ends the child
            preexec_fn=_die_with_parent,  # safe: this process has no threads
        )
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


def _die_with_parent() -> None:
    """Ask the kernel to kill this child when its parent dies, even by SIGKILL."""
    _PRCTL(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _kill(child: subprocess.Popen[str]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()
