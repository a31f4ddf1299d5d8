"""Commits of a git repository, checked out and built in folders that are gone afterwards."""

import contextlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from experiments.support import process
from support.errors import InputError

_LAST_LINES = 12
"""Of what a build that failed has said."""


@dataclass(frozen=True)
class Commit:
    """A commit, by its full hash and the name that the user gave."""

    sha: str
    name: str

    @property
    def short(self) -> str:
        """What it is called where it is shown."""
        return self.sha[:10]


@dataclass(frozen=True)
class Repository:
    """A repository, and the folder below its top from which the user asks."""

    top: Path
    below: Path

    def commit(self, name: str, option: str) -> Commit:
        """The commit that a name means. Raises InputError where it means none."""
        done = _git(self.top, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{name}^{{commit}}")
        if done.exit_code != 0:
            raise InputError(f"{option}: found {name}, expected a commit of {self.top}")
        return Commit(done.output.strip(), name)

    @property
    def is_changed(self) -> bool:
        """Whether something in it is not committed."""
        return bool(_git(self.top, "status", "--porcelain").output.strip())

    @contextlib.contextmanager
    def checked_out(self, commit: Commit, folder: Path) -> Iterator[Path]:
        """Check a commit out into `folder`; gives the folder in it that the user's own corresponds to."""
        done = _git(self.top, "worktree", "add", "--detach", "--force", str(folder), commit.sha)
        try:
            if done.exit_code != 0:
                raise InputError(f"{commit.name}: cannot be checked out: {done.reason}")
            yield folder / self.below
        finally:
            _git(self.top, "worktree", "remove", "--force", "--force", str(folder))
            _git(self.top, "worktree", "prune")


def repository() -> Repository:
    """That of the folder in which the user is. Raises InputError where there is none."""
    here = Path.cwd()
    done = _git(here, "rev-parse", "--show-toplevel")
    if done.exit_code != 0:
        raise InputError(f"{here}: is no git repository, expected one to compare two commits of")
    top = Path(done.output.strip())
    return Repository(top, here.resolve().relative_to(top.resolve()))


def build(line: str, folder: Path, commit: Commit) -> None:
    """Run the line that builds. Raises InputError with the last of what it said where it fails."""
    if not folder.is_dir():
        raise InputError(f"{commit.name}: has no folder {folder.name}, from which it was asked for")
    done = process.run(("sh", "-c", f"{line} 2>&1"), dict(os.environ), folder=folder)
    if done.exit_code != 0:
        said = " | ".join(one.strip() for one in done.output.splitlines()[-_LAST_LINES:] if one.strip())
        raise InputError(f"--build: {commit.name} ({commit.short}) does not build: {said or done.reason}")


def _git(folder: Path, *words: str) -> process.Completed:
    return process.run(("git", "-C", str(folder), *words))
