"""The figures and measured tables of README and docs: what each measured, where and when, and whether that
has changed since. `docs/figures/figures.toml` lists them.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

from docs.generate import sources
from support.errors import InputError, not_one_of
from support.home import ROOT

TABLE = ROOT / "docs" / "figures" / "figures.toml"
OLDER = "older than the code"
"""What a page has to say of a figure that is stale and cannot be made again here."""


@dataclass(frozen=True)
class Figure:
    """One entry. `files` are made by `command`, each from a file that it leaves in a results folder.

    A measured table has no file, or one of data: `shown` is a text by which its page is known. `origin` is
    what tells commit, date and machine. `needs` says what another machine must have to make it again. `same`
    says why what changed since in its sources cannot change it; its digest is then that of the present ones.
    """

    name: str
    measures: str
    sources: tuple[str, ...]
    commit: str
    measured: date
    machine: str
    digest: str
    command: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    origin: str = ""
    minutes: float | None = None
    needs: str = ""
    same: str = ""
    shown: str = ""
    is_measurement: bool = True
    """Or a picture, of which no page says commit, date and machine."""

    @property
    def marks(self) -> tuple[str, ...]:
        """Texts by which a page that shows it is known."""
        return (self.shown,) if self.shown else tuple(Path(one).name for one in self.files)


def load(table: Path = TABLE) -> dict[str, Figure]:
    """All entries by name. Raises InputError for an unknown key or a group that there is not."""
    content = tomllib.loads(table.read_text(encoding="utf-8"))
    groups = content.pop("groups", {})
    try:
        return {
            name: Figure(name, **{**one, "sources": tuple(_expanded(one["sources"], groups))})
            for name, one in content.items()
        }
    except (TypeError, KeyError) as error:
        raise InputError(f"{table}: {error}, expected the keys of the other entries") from error


def _expanded(patterns: Sequence[str], groups: Mapping[str, Sequence[str]]) -> Iterator[str]:
    for one in patterns:
        yield from groups[one.removeprefix("@")] if one.startswith("@") else [one]


def is_stale(figure: Figure, root: Path = ROOT) -> bool:
    """Whether what it measured has changed since."""
    return sources.digest(root, figure.sources) != figure.digest


def chosen(names: str, table: Path = TABLE) -> list[Figure]:
    """Those named between commas; without a name the stale ones that can be made here. Raises InputError."""
    all_of_them = load(table)
    wanted = [one.strip() for one in names.split(",") if one.strip()]
    for name in wanted:
        if name not in all_of_them:
            raise InputError(f"FIGURES: {not_one_of(name, all_of_them)}")
        if not all_of_them[name].command:
            raise InputError(f"FIGURES: {name} needs {all_of_them[name].needs}: no command makes it")
    if wanted:
        return [all_of_them[name] for name in wanted]
    return [one for one in all_of_them.values() if one.command and not one.needs and is_stale(one)]


def listing(table: Path = TABLE) -> str:
    """A line an entry: whether it is stale, of what it is, and how long it takes to make again."""
    lines = []
    for one in load(table).values():
        takes = "time not known" if one.minutes is None else f"{one.minutes:g} min"
        state = "stale" if is_stale(one) else "as measured" if not one.same else "unchanged in effect"
        needs = f", needs {one.needs}" if one.needs else ""
        lines.append(f"{one.name:20} {state:20} {one.commit} {one.measured} {takes}{needs}")
    return "\n".join(lines)


def complaints(figure: Figure, pages: Mapping[str, str], root: Path = ROOT) -> list[str]:
    """What is wrong with a figure and with the pages that show it, which are given by name."""
    showing = {name: text for name, text in pages.items() if any(mark in text for mark in figure.marks)}
    if not showing and not figure.shown:
        return [f"{figure.name}: no page shows it"]
    silent = [
        name for name, text in showing.items() if figure.is_measurement and not says_origin(figure, text)
    ]
    found = [f"{name}: does not say of {figure.name} that it is of {_origin(figure)}" for name in silent]
    if not is_stale(figure, root):
        return found
    if not figure.needs:
        again = f"`make docs FIGURES={figure.name}` makes it again" if figure.command else "measure it again"
        return [*found, f"{figure.name}: what it measured has changed since {figure.commit}: {again}"]
    captions = {name: caption(figure, text) for name, text in showing.items()}
    return found + [
        f'{name}: says nowhere beside {figure.name} "commit {figure.commit}", its date and "{OLDER}"'
        for name, text in captions.items()
        if not (says_origin(figure, text) and OLDER in text)
    ]


def _origin(figure: Figure) -> str:
    return f"commit {figure.commit} and {figure.measured} ({day(figure.measured)})"


def says_origin(figure: Figure, text: str) -> bool:
    """Whether a text names its commit and its date."""
    return figure.commit in text and any(one in text for one in (str(figure.measured), day(figure.measured)))


def day(measured: date) -> str:
    """A date as pages write it in sentences."""
    return f"{measured.day} {measured:%B %Y}"


def caption(figure: Figure, text: str) -> str:
    """What stands beside it on a page: its paragraph, the one before and the two after, lines joined."""
    paragraphs = [" ".join(one.split()) for one in re.split(r"\n\s*\n", text)]
    near = {
        beside
        for at, one in enumerate(paragraphs)
        if any(mark in one for mark in figure.marks)
        for beside in range(max(at - 1, 0), at + 3)
    }
    return "\n".join(paragraphs[at] for at in sorted(near) if at < len(paragraphs))
