"""Tables and texts of generated pages."""

from collections.abc import Iterable, Sequence

NOTICE = "<!-- Made by `make docs`: what is changed here is lost. -->"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; a bar within a cell is kept from ending it."""
    cells = [[_cell(one) for one in row] for row in rows]
    lines = [list(head), ["---"] * len(head), *cells]
    return "\n".join(
        f"| {' | '.join(line)} |".replace("|  |", "| |").replace("|  |", "| |") for line in lines
    )


def _cell(text: str) -> str:
    return " ".join(text.replace("|", "\\|").split())


def code(text: str) -> str:
    """The text as code, nothing for no text."""
    return f"`{text}`" if text else ""


def page(title: str, *parts: str) -> str:
    """A whole page: its notice, its title and its parts, with one line between them."""
    return "\n\n".join([NOTICE, f"# {title}", *filter(None, parts)]) + "\n"


def with_large_letter(text: str) -> str:
    """The text as it begins a cell or a sentence; names and values of programs stay as they are."""
    first = text.split(" ", 1)[0]
    return text if "_" in first or first in ("true:", "false:") else text[:1].upper() + text[1:]


def sentence(text: str) -> str:
    """The text with a large first letter and a full stop."""
    text = with_large_letter(text.strip())
    return text if not text or text.endswith((".", "?", ":")) else f"{text}."
