"""The result for people: as Markdown for a comment or a job's summary, as a page of HTML with its picture."""

from pathlib import Path

import jinja2

from experiments.compare.found import Found
from experiments.compare.texts import in_order, row, verdict


def title(found: Found) -> str:
    """The verdict in a line."""
    asked, answer = found.asked, found.answer
    if answer.is_withdrawn:
        return f"withdrawn: {asked.reference} differs from itself"
    if not answer.commands:
        return "nothing is known yet"
    if len(answer.commands) == 1:
        [one] = answer.commands
        return f"{one.name} against {asked.reference}: {verdict(one, asked)}"
    number = sum(one.is_settled for one in answer.commands)
    return f"{number} of {len(answer.commands)} comparisons with {asked.reference} are settled"


def markdown(found: Found, said: list[str], first: str, again: str) -> str:
    """A table with the line `first` above it, and folded below it the machine and how to repeat it: `said`,
    the lines of the result, and `again`, the command line.
    """
    rows = [_columns(found), ["---"] * len(_columns(found)), *_rows(found)]
    lines = "\n".join(f"| {' | '.join(one.replace('|', chr(92) + '|') for one in cells)} |" for cells in rows)
    folded = "\n".join(f"    {one}" for one in _how(found, said, again))
    return (
        f"**{first}**\n\n{lines}\n\n<details><summary>Machine, commands, how to repeat it</summary>\n\n"
        f"{folded}\n\n</details>\n"
    )


def page(found: Found, said: list[str], first: str, again: str, picture: Path | None) -> str:
    """A page of its own, which asks nothing of any other file; of the picture what is behind its prologue."""
    drawn = picture.read_text(encoding="utf-8") if picture is not None else ""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        undefined=jinja2.StrictUndefined,
        autoescape=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("page.html.jinja").render(
        title=first,
        columns=_columns(found),
        rows=_rows(found),
        picture=drawn[drawn.find("<svg") :] if drawn else "",
        lines=_how(found, said, again),
    )


def _columns(found: Found) -> list[str]:
    told = ["case", "time"] if found.asked.cases else ["comparison"]
    return [*told, "change of time", "verdict"]


def _rows(found: Found) -> list[list[str]]:
    return [row(one, found) for one in in_order(found)]


def _how(found: Found, said: list[str], again: str) -> list[str]:
    commands = [f"{one.name}: {one.line}" for one in found.asked.commands]
    return [found.machine, *commands, *(one.strip() for one in said), f"again: {again}"]
