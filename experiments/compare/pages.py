"""The result for people: as Markdown for a comment or a job's summary, as a page of HTML with its picture."""

from html import escape
from pathlib import Path

from experiments.compare.found import Found
from experiments.compare.texts import in_order, row, verdict

_STYLE = """body { font: 16px/1.5 system-ui, sans-serif; max-width: 52rem; margin: 2rem auto; }
h1 { font-size: 1.3rem; } table { border-collapse: collapse; }
td, th { padding: .2rem .8rem .2rem 0; text-align: left; border-bottom: 1px solid #ddd; }
pre { overflow-x: auto; background: #f6f6f6; padding: .6rem; } svg { width: 100%; height: auto; }"""


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
    """A page of its own, which asks nothing of any other file."""
    head, *rows = [_columns(found), *_rows(found)]
    cells = "".join(f"<th>{escape(one)}</th>" for one in head)
    body = "\n".join("<tr>" + "".join(f"<td>{escape(one)}</td>" for one in cells) + "</tr>" for cells in rows)
    drawn = _inline(picture) if picture is not None else ""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(first)}</title>
<style>
{_STYLE}
</style>
</head>
<body>
<h1>{escape(first)}</h1>
<table>
<tr>{cells}</tr>
{body}
</table>
{drawn}
<details open><summary>Machine, commands, how to repeat it</summary>
<pre>{escape(chr(10).join(_how(found, said, again)))}</pre>
</details>
</body>
</html>
"""


def _columns(found: Found) -> list[str]:
    told = ["case", "time"] if found.asked.cases else ["comparison"]
    return [*told, "change of time", "verdict"]


def _rows(found: Found) -> list[list[str]]:
    return [row(one, found) for one in in_order(found)]


def _how(found: Found, said: list[str], again: str) -> list[str]:
    commands = [f"{one.name}: {one.line}" for one in found.asked.commands]
    return [found.machine, *commands, *(one.strip() for one in said), f"again: {again}"]


def _inline(picture: Path) -> str:
    """The picture as a part of the page: without what stands before its first element."""
    text = picture.read_text(encoding="utf-8")
    return text[text.index("<svg") :]
