"""A time that a program says of itself."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class StatedTime:
    """In seconds, with what a Google Benchmark tells beside."""

    seconds: float
    cpu_seconds: float = 0.0
    """0 where it does not say."""
    counters: dict[str, float | None] = field(default_factory=dict)
    """The mean over the repetitions; None where one of them has no finite number."""
    library_version: str | None = None
    threads: int = 1
    waited_seconds: None = None
    """Which no program knows."""


def on_one_line(text: str, longest: int = 200) -> str:
    """A text of somebody else in a message of one line: not too long, line breaks and other characters that
    steer a terminal as question marks.
    """
    shown = "".join("?" if letter < " " or letter == "\x7f" else letter for letter in text[:longest])
    return shown + ("..." if len(text) > longest else "")


def in_quotes(text: str, longest: int = 40) -> str:
    """What was found, between quotes, all that is no printed ASCII as question marks."""
    shown = "".join(letter if " " <= letter <= "~" else "?" for letter in text[:longest])
    return f"'{shown}{'...' if len(text) > longest else ''}'"
