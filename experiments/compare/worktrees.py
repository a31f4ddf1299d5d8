"""Commits of a git repository, checked out and built in folders that are gone afterwards."""

import contextlib
import glob
import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from experiments.run.progress import warn
from experiments.support import process
from experiments.support.vanishing import marked
from support.errors import InputError

_ON_ITS_WAY = "Preparing worktree"
"""What git says where nothing is wrong."""

_LAST_LINES = 12
"""Of what a build that failed has said."""

_OF_A_HOOK = frozenset(("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX", "GIT_COMMON_DIR"))
"""Variables by which git tells a hook where it is: in a folder of its own they would mean the user's."""


@dataclass(frozen=True)
class Commit:
    """A commit, by its full hash and the name that the user gave."""

    sha: str
    name: str

    @property
    def short(self) -> str:
        """What it is called where it is shown."""
        return self.sha[:10]

    def __str__(self) -> str:
        return f"{self.name} ({self.short})"


@dataclass(frozen=True)
class Tree:
    """A commit that is checked out, and the folder in it that the user's own corresponds to."""

    commit: Commit
    top: Path
    folder: Path
    repository: Path
    """The user's own checkout."""


@dataclass(frozen=True)
class Repository:
    """A repository, and the folder below its top from which the user asks."""

    top: Path
    below: Path

    def commit(self, name: str, option: str) -> Commit:
        """The commit that a name means. Raises InputError where it means none."""
        done = git(self.top, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{name}^{{commit}}")
        if done.exit_code == 0:
            return Commit(done.output.strip(), name)
        if not git(self.top, "rev-list", "--all", "--max-count=1").output:
            raise InputError(f"{self.top}: has no commits, expected two to compare")
        raise InputError(f"{option}: found {name}, expected a commit of {self.top}{self._cut_off}")

    def merge_base(self, base: Commit, head: Commit) -> Commit:
        """The commit at which the head left the base; says how many of the base's own the head lacks. Raises
        InputError where there is none, or where the head has none of its own.
        """
        found = git(self.top, "merge-base", base.sha, head.sha).output.strip()
        if found in ("", head.sha):
            nothing = f"no commit in common with {base.name}{self._cut_off}"
            told = f"nothing that {base.name} lacks" if found else nothing
            raise InputError(f"{head.name} has {told}; --base-exactly compares them all the same")
        number = int(git(self.top, "rev-list", "--count", f"{head.sha}..{base.sha}").output)
        if number == 0:
            return base
        lacks = "1 commit" if number == 1 else f"{number} commits"
        lacks = f"{lacks} of {base.name} since then {'is' if number == 1 else 'are'} not in {head.name}"
        told = f"{lacks} (--base-exactly compares with {base.name} itself)"
        warn(f"carom: compared with {found[:10]}, where {head.name} left {base.name}; {told}")
        return Commit(found, f"the merge base of {base.name} and {head.name}")

    @property
    def is_changed(self) -> bool:
        """Whether something in it is not committed."""
        return bool(git(self.top, "status", "--porcelain").output.strip())

    @contextlib.contextmanager
    def checked_out(self, commit: Commit, top: Path) -> Iterator[Tree]:
        """Check a commit out into the folder `top`, with its submodules. Raises InputError."""
        done = git(self.top, "worktree", "add", "--detach", "--force", str(top), commit.sha)
        try:
            if done.exit_code != 0:
                raise InputError(f"{commit}: cannot be checked out: {_reason(done)}")
            self._fill(top, self.top, commit)
            if not (top / self.below).is_dir():
                raise InputError(f"{commit}: has no folder {self.below}, from which it was asked for")
            yield Tree(commit, top, top / self.below, self.top)
        finally:
            git(self.top, "worktree", "remove", "--force", "--force", str(top))
            git(self.top, "worktree", "prune")

    def _fill(self, top: Path, users: Path, commit: Commit) -> None:
        """Fill the submodules of what is checked out, and theirs, from what the user's own repository has of
        them, which it leaves alone; else from where they come. Raises InputError.
        """
        # With -d only folders and submodules are listed: all files might be more than is kept of an output.
        listed = git(top, "ls-tree", "-r", "-d", "-z", "HEAD").output.split("\0")
        for entry in (one for one in listed if one.startswith("160000 ")):
            about, path = entry.split("\t", 1)
            folder, sha = top / path, about.split()[2]
            _borrow(folder, [*self._stores, *users.glob(f"{glob.escape(path)}/.git/objects")])
            done = git(folder, "checkout", "--quiet", "--detach", sha)
            if done.exit_code != 0:
                shutil.rmtree(folder)
                folder.mkdir()
                # With --init it would write into the user's own configuration.
                done = git(top, "-c", "submodule.active=.", "submodule", "--quiet", "update", "--", path)
            if done.exit_code != 0:
                told = f"{commit}: the submodule {path} cannot be checked out: {_reason(done)}"
                raise InputError(f"{told}; `git config submodule.NAME.update none` leaves one empty")
            if (folder / ".git").exists():
                # What is borrowed has none, and where submodules of it come from may be told from there.
                url = git(users / path, "remote", "get-url", "origin").output.strip()
                git(folder, "remote", "add", "origin", url)
                self._fill(folder, users / path, commit)

    @cached_property
    def _stores(self) -> list[Path]:
        """The folders with objects of all submodules, also of those that are not checked out now."""
        said = git(self.top, "rev-parse", "--path-format=absolute", "--git-common-dir").output
        places = ("modules/**/objects/pack", "worktrees/*/modules/**/objects/pack")
        return [one.parent for place in places for one in Path(said.removesuffix("\n")).glob(place)]

    @property
    def _cut_off(self) -> str:
        """That a clone is shallow, and what brings the rest; nothing of others."""
        if git(self.top, "rev-parse", "--is-shallow-repository").output.strip() != "true":
            return ""
        remedy = "`git fetch --unshallow origin '+refs/heads/*:refs/remotes/origin/*'`"
        return f"; the clone is shallow: {remedy} (fetch-depth: 0 of actions/checkout) brings all commits"


def repository() -> Repository:
    """That of the folder in which the user is. Raises InputError where there is none."""
    here = Path.cwd()
    done = git(here, "rev-parse", "--show-toplevel")
    if done.exit_code == process.NOT_FOUND:
        raise InputError(f"{done.error}; expected git on PATH, to check out the commits")
    if done.exit_code != 0:
        if git(here, "rev-parse", "--is-bare-repository").output.strip() == "true":
            raise InputError(f"{here}: is a bare repository, expected one with files; `git clone` makes one")
        raise InputError(f"{here}: expected a git repository to compare two commits of: {_reason(done)}")
    top = Path(done.output.removesuffix("\n"))
    return Repository(top, here.resolve().relative_to(top.resolve()))


def build(line: str, tree: Tree) -> None:
    """Run the line that builds. Raises InputError with the last of what it said where it fails."""
    done = process.run(
        ("sh", "-c", f"{line} 2>&1"), marked(_environment(), tree.top.parent), folder=tree.folder
    )
    if done.exit_code != 0:
        said = " | ".join(one.strip() for one in done.output.splitlines()[-_LAST_LINES:] if one.strip())
        raise InputError(f"--build: {tree.commit} does not build: {said or done.reason}")


def git(folder: Path, *words: str) -> process.Completed:
    """Run git in a folder."""
    return process.run(("git", "-C", str(folder), *words), _environment())


def _environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name not in _OF_A_HOOK}


def _reason(done: process.Completed) -> str:
    """All that git says of why it failed, in one line: the remedy stands below the reason."""
    lines = (line.strip() for line in done.error.splitlines() if not line.startswith(_ON_ITS_WAY))
    said = " ".join(dict.fromkeys(filter(None, lines)))
    return said.removeprefix("fatal: ") or f"exit code {done.exit_code} without a word, as of a hook"


def _borrow(folder: Path, stores: list[Path]) -> None:
    """Make a repository that has all objects of these folders."""
    git(Path("/"), "init", "--quiet", "--template=", str(folder))
    (folder / ".git/objects/info/alternates").write_text("".join(f"{one}\n" for one in stores), "utf-8")
    ends = [one.with_name("shallow") for one in stores if one.with_name("shallow").is_file()]
    if ends:
        (folder / ".git/shallow").write_text("".join(one.read_text("utf-8") for one in ends), "utf-8")
