"""How a program ended with all that it had started, and what that took, as `carom processes` tells it."""

from collections.abc import Collection
from dataclasses import dataclass

from experiments.support.process import NOT_FOUND, TIMED_OUT, name_of_signal

_NO_TERMINAL = "it had no terminal: its standard input is empty, its outputs are pipes"
"""Some programs end at once where nobody can type, or read what they draw."""


@dataclass(frozen=True)
class RunResult:
    """The facts of one run."""

    seconds: list[float]
    """Wall time of each slice in which it was let run."""
    seconds_alone: float
    """What of it ran after all that took turns with it had ended."""
    idle_seconds: float
    """In which processors had nothing to do meanwhile, of all together."""
    not_started: str
    """Why it could not be run."""
    unknown: str
    """Why nobody knows how it ended."""
    suspended: str
    """How it is known that it stood still although nobody here wanted it to."""
    exit_code: int
    signal: int
    """The one that killed it, or 0."""
    out_of_time: bool
    went_on: str
    """The names of what it had started and that went on after its own end."""
    seconds_left_behind: float
    """How long what it had started went on after its own end."""
    user_seconds: float
    system_seconds: float
    waited_seconds: float | None
    """In which all of it that could run waited for a processor."""
    peak_memory_bytes: int | None
    memory_of: str
    """Of what that is the peak, or why it is not known."""
    counted: dict[str, float]
    """Page faults, context switches, and what the hardware counts."""
    ran_on: int
    """Slices that were longer since it did not stand still."""
    tree: str
    """What kept all of it together: cgroup or subreaper."""
    output_bytes: int
    error_bytes: int
    output_end: str
    error_end: str
    """The last line of its standard error."""

    @property
    def wall_seconds(self) -> float:
        """In which it was let run."""
        return sum(self.seconds)

    @property
    def own_seconds(self) -> float:
        """Less what it waited for a processor, as far as that is known."""
        return self.wall_seconds - (self.waited_seconds or 0.0)

    @property
    def cpu_seconds(self) -> float:
        """Of all that it started."""
        return self.user_seconds + self.system_seconds

    def why_failed(self, fine: Collection[int], folder: str, most_seconds: float) -> str:
        """Why it does not count for whoever wants an exit code out of `fine`; empty if it does."""
        after = f": {self.error_end}" if self.error_end else ""
        if self.not_started:
            return f"cannot be run{f' in {folder}' if folder else ''}: {self.not_started}"
        if self.suspended:
            return self.suspended
        if self.out_of_time:
            how = f"; {self.unknown}" if self.unknown else " and was killed"
            went_on = f"; it had ended, and what it had started went on: {self.went_on}"
            return f"took longer than {most_seconds:g} s{how}{went_on if self.went_on else ''}"
        if self.went_on:
            return f"left {self.went_on} running in the background, expected nothing beside what is timed"
        if self.unknown:
            return f"nobody knows how it ended: {self.unknown}"
        if self.signal:
            return f"killed by {name_of_signal(self.signal)}{after}"
        if self.exit_code not in fine:
            return f"exit code {self.exit_code}{after or f' without a word; {_NO_TERMINAL}'}"
        return ""

    @property
    def failure_code(self) -> int:
        """Its exit code as a run that failed, never 0: its own, 1 where that is 0, as of timeout(1) and of a
        shell where it took too long or cannot be run, the signal that killed it below 0.
        """
        if self.out_of_time:
            return TIMED_OUT
        if self.signal:
            return -self.signal
        return NOT_FOUND if self.not_started else max(self.exit_code, 1)
