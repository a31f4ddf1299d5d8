"""How far the study is: a bar with the time left on a terminal, plain lines elsewhere."""

from collections.abc import Callable
from dataclasses import dataclass

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from support.command_line import tell


@dataclass(frozen=True)
class Status:
    """Processes planned and done, and seconds of wall time done and left."""

    planned: int
    done: int
    seconds_done: float
    seconds_left: float

    def __str__(self) -> str:
        return f"{self.done} of {self.planned} processes done, {about(self.seconds_left)} left"


class ProgressDisplay:
    """What the user sees while a study runs; a context manager.

    The bar is drawn between processes only: a thread that redrew it would take time from what is measured.
    """

    def __init__(self) -> None:
        self._console = Console(soft_wrap=True, highlight=False, markup=False)
        columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[status]}"))
        self._bar = Progress(*columns, console=self._console, auto_refresh=False, transient=True)
        self._task = self._bar.add_task("", total=None, status="")

    def __enter__(self) -> "ProgressDisplay":
        if self._console.is_terminal:
            self._bar.start()
        return self

    def __exit__(self, *error: object) -> None:
        if self._console.is_terminal:
            self._bar.stop()

    def now(self, what: str, status: Callable[[], Status] | None = None) -> None:
        """Something begins: `what` is shown beside the bar, if there is one."""
        if not self._console.is_terminal:
            return
        if status is not None:
            now = status()
            total = now.seconds_done + now.seconds_left
            self._bar.update(self._task, completed=now.seconds_done, total=total, status=str(now))
        self._bar.update(self._task, description=what, refresh=True)

    def block(self, what: str, status: Callable[[], Status]) -> None:
        """A block ended: one line where there is no bar."""
        if not self._console.is_terminal:
            self._console.print(f"{what}: {status()}")

    def line(self, text: str) -> None:
        """One line that stays."""
        self._console.print(text)


def about(seconds: float) -> str:
    """A duration in the words of a person: `about 25 s`, `about 12 min`, `about 2 h 05 min`."""
    if seconds < 100:
        return f"about {max(1, round(seconds))} s"
    minutes = round(seconds / 60)
    if minutes < 100:
        return f"about {minutes} min"
    return f"about {minutes // 60} h {minutes % 60:02d} min"


def several(number: int, noun: str) -> str:
    """So many of what has that name."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


warn = tell
