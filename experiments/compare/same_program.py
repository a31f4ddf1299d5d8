"""Whether each of two commits runs what was built of it: builds that share a place make both run one file."""

import contextlib
import filecmp
import os
import re
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.compare.commands import words_in
from experiments.compare.first_run import NotMeantError
from experiments.compare.worktrees import Tree, git
from experiments.plan.executable import is_file
from experiments.run.progress import warn
from experiments.support.process import run
from support.errors import InputError

_NO_SOURCE = re.compile(
    r"(.*/)?((docs?|tests?|testing|examples?|\.[^/]*)/.*|\.[^/]*|(README|LICENSE|CHANGELOG)[^/]*"
    r"|(?!CMakeLists)[^/]*(?i:\.(md|rst|txt|adoc|ya?ml)))",
    re.DOTALL,
)
"""The names of files that go into no program: pages, tests, examples, settings of tools."""

_LEADING = re.compile(r"(?!(MAN|INFO)?PATH|GITHUB_|CI_)\w*(PATH|LIB|PRELOAD)")
"""The names of variables by which programs find parts of themselves."""

_ABSOLUTE = re.compile(r"(?:(?<![\w.$})~/])|(?<=\s-[A-Z]))/[\w.+/-]+")
"""A path in a line of a shell or of a Makefile, also one that an option has without a blank."""

_OF_A_BUILD = ("Makefile", "makefile", "GNUmakefile")
"""What a build reads although its line does not name it."""

_LONGEST_SCRIPT = 1 << 16
"""Bytes of a script whose words are looked at."""


def require_two_files(words: Sequence[str], base: Tree, head: Tree, since: int, *, is_accepted: bool) -> None:
    """Raises InputError for a file that both commits run or read: one of the user's own checkout, or one that
    their builds wrote, which has changed since a time of the file system, in nanoseconds, as all that is in
    the trees has; and, unless that `is_accepted`, for a program from elsewhere beside nothing of the trees.
    """
    if not is_accepted:
        _require_own(words[0], head)
    own, trees = base.repository.resolve(), base.top.resolve().parent
    of_base, of_head = (set(_read(words, tree.folder)) for tree in (base, head))
    led = [*_folders(words), *_of_texts(words, head), *(() if is_accepted else _of_python(words, head))]
    for word, path in sorted({*of_head, *led}):
        if path.exists() and path.is_relative_to(own) and not path.is_relative_to(trees):
            told = "of your own checkout: both commits would use it"
            raise InputError(f"found {word}, {told}; expected a path inside the checkout, such as ./prog")
    for word, path in sorted(of_head & of_base):
        if path.stat().st_ctime_ns > since:
            found = word if word == str(path) else f"{word}, which is {path}"
            told = "written by the builds: both commits would use what was built last"
            raise InputError(f"found {found}, {told}; expected a path inside the checkout, such as ./prog")
    for word, path in _on_paths_of_python(words, head.folder):
        if not (is_accepted or path.is_relative_to(trees)) and path.stat().st_ctime_ns > since:
            told = f"found {path}, which {word} may load, written by the builds: both commits would use"
            raise InputError(f"{told} what was built last; expected it inside the checkout, or --same-bytes")
    named = {*_parts(words)}
    absolute = next((word for word, _ in sorted(of_head) if word in named and word.startswith("/")), None)
    first = absolute or next((word for word, _ in sorted(of_head)), None)
    if first and not any(path.is_relative_to(trees) for _, path in of_head) and not _is_in(head, words):
        told = f"both commits use {first}, and nothing that the command names lies in the checkout"
        if absolute and not (is_accepted or _is_of_the_system(absolute)):
            raise InputError(f"{told}; expected a path inside it, or --same-bytes to compare all the same")
        warn(f"carom: {told}")


def _is_in(tree: Tree, words: Sequence[str]) -> bool:
    """Whether words name a folder or a module of Python of a tree."""
    parts = [part for part in _parts(words) if part.strip("./") and not part.startswith("/")]
    places = [tree.folder / one for part in parts for one in (part, f"{part.replace('.', '/')}.py")]
    return any(place.exists() for place in places)


def tell_own_path(base: Tree) -> None:
    """Say which folders of PATH lie in the user's own checkout: both commits run what is named there."""
    own, trees = base.repository.resolve(), base.top.resolve().parent
    for part in os.environ.get("PATH", "").split(os.pathsep):
        path = Path(part).resolve()
        if part.startswith("/") and path.is_relative_to(own) and not path.is_relative_to(trees):
            warn(f"carom: PATH={part}, of your own checkout: both commits run programs that lie there")


def _folders(words: Sequence[str]) -> Iterator[tuple[str, Path]]:
    """The absolute paths that words name, and variables by which programs find parts of themselves."""
    led = [
        (f"{name}={part}", part)
        for name, value in os.environ.items()
        if _LEADING.fullmatch(name)
        for part in value.split(os.pathsep)
    ]
    for told, path in (*((word, word) for word in _parts(words)), *led):
        if path.startswith("/"):
            yield told, Path(path).resolve()


def _of_texts(words: Sequence[str], tree: Tree) -> Iterator[tuple[str, Path]]:
    """The user's own checkout, where scripts that words name, or that these name, have its path in them."""
    own = tree.repository.resolve()
    itself = re.compile(re.escape(str(own)) + r"(?![\w.-])")
    for word, path in _read(words, tree.folder):
        if any(map(itself.search, _words_of_script(path))):
            yield f"{own} in {word}", own


def _of_python(words: Sequence[str], tree: Tree) -> Iterator[tuple[str, Path]]:
    """Where the Python that words name looks for modules beside its own places, as it does for a package that
    was installed to be edited, each with what is told of it.
    """
    own = tree.repository.resolve()
    for word, places, prefix in _pythons(words, tree.folder):
        editable = (file for place in places for file in place.glob("__editable__*.py"))
        named = [own for file in editable if f"{own}/" in file.read_text(encoding="utf-8", errors="replace")]
        for one in (*(one for one in places if not one.is_relative_to(prefix)), *named):
            yield f"{one}, where {word} looks for modules (--same-bytes accepts that)", one.resolve()


def require_two_libraries(loaded: Sequence[Path], trees: Path, since: int) -> None:
    """Raises NotMeantError for a library outside the trees that was written since they were made."""
    for path in loaded:
        if not path.is_relative_to(trees.resolve()) and path.stat().st_ctime_ns > since:
            told = "written by the builds and loaded: both commits use what was built last"
            raise NotMeantError(f"found {path}, {told}; expected it inside the checkout")


def tell_shared_places(line: str, base: Tree, since: int) -> None:
    """Say which places outside the trees, named by the line that builds or by what it runs, the builds have
    written to since a time of the file system: what one commit left there may be in the program of the other.
    """
    trees = base.top.resolve().parent
    read = {path for _, path in _named([*words_in(line), *_OF_A_BUILD], base.folder)}
    scripts = " ".join(" ".join(_words_of_script(path)) for path in read if path.is_relative_to(trees))
    said = f" {line} {scripts}".replace(" ~/", " $HOME/")
    for word in sorted(set(_ABSOLUTE.findall(os.path.expandvars(said)))):
        path = Path(word).resolve()
        if path.is_relative_to("/dev") or path.is_relative_to(trees) or trees.is_relative_to(path):
            continue
        with contextlib.suppress(OSError):
            inside = (path, *path.iterdir()) if path.is_dir() else (path,)
            if any(one.lstat().st_ctime_ns > since for one in inside):
                told = "which both builds share: what one left there may be in the program of the other"
                warn(f"carom: --build writes to {word}, {told}")


def _require_own(word: str, tree: Tree) -> None:
    """Raises InputError for a program on PATH beside one of that name in a tree."""
    on_path = shutil.which(word) if "/" not in word else None
    if on_path and is_file(tree.folder / word):
        told = f"found {word}, which is {on_path} for both commits; expected ./{word}"
        raise InputError(f"{told}, which they have, or --same-bytes to compare all the same")


def _is_of_the_system(word: str) -> bool:
    """Whether it lies in a folder of PATH, as make and other tools do that find their input themselves."""
    return str(Path(word).parent) in os.environ.get("PATH", os.defpath).split(os.pathsep)


def require_two_programs(words: Sequence[str], base: Tree, head: Tree) -> None:
    """Raises InputError where all that is built and named is the same, byte for byte, although the commits
    differ in sources; says so where they do not.
    """
    of_base, of_head = (dict(_built(words, tree)) for tree in (base, head))
    both = [word for word in of_base if word in of_head]
    if not both or not all(filecmp.cmp(of_base[word], of_head[word], shallow=False) for word in both):
        return
    commits = (base.commit.sha, head.commit.sha)
    names = git(head.top, "diff-tree", "-r", "-z", "--name-only", *commits).output.split("\0")[:-1]
    sources = [name for name in names if not _NO_SOURCE.fullmatch(name)]
    if sources:
        told = f"{both[0]} with the same bytes in both commits, which differ in {sources[0]}"
        asked = "do the builds share something, such as a fixed build folder or an installed file?"
        raise InputError(f"found {told}; {asked} --same-bytes compares them all the same")
    warn(f"carom: base and head build the same bytes of {both[0]}: no source differs")


def _built(words: Sequence[str], tree: Tree) -> Iterator[tuple[str, Path]]:
    """The files of a tree that words name and git does not know: a script that it knows reads other files."""
    for word, path in _named(words, tree.folder):
        known = ("--literal-pathspecs", "ls-files", "--error-unmatch", path.name)
        if path.is_relative_to(tree.top.resolve()) and git(path.parent, *known).exit_code != 0:
            yield word, path


def _named(words: Sequence[str], folder: Path) -> Iterator[tuple[str, Path]]:
    """The files that words name in a folder or on PATH, without links; devices are none."""
    for word in _parts(words):
        on_path = shutil.which(word) if "/" not in word else None
        for path in (folder / word, Path(on_path or folder)):
            if is_file(path) and not word.startswith(("/dev/", "/proc/")):
                yield word, path.resolve()


def _read(words: Sequence[str], folder: Path) -> Iterator[tuple[str, Path]]:
    """The files that words name, and those that the scripts among them do."""
    for word, path in _named(words, folder):
        yield word, path
        yield from _named([one for one in _words_of_script(path) if "/" in one], folder)


def _words_of_script(file: Path) -> list[str]:
    """All words of a file that is a text, unless it is long; of any other file none."""
    try:
        content = file.read_bytes() if is_file(file) and file.stat().st_size <= _LONGEST_SCRIPT else b""
    except OSError:
        return []
    return [] if b"\0" in content else words_in(content.decode("utf-8", errors="replace"))


def _on_paths_of_python(words: Sequence[str], folder: Path) -> Iterator[tuple[str, Path]]:
    """What lies where the Python that words name looks for modules, each with that word."""
    for word, places, _ in _pythons(words, folder):
        for place in filter(Path.is_dir, places):
            yield from ((word, one) for one in place.iterdir() if one.name != "__pycache__" and one.exists())


def _pythons(words: Sequence[str], folder: Path) -> Iterator[tuple[str, list[Path], Path]]:
    """Each Python that words name, the places where it looks for modules, and its own place."""
    code = "import sys; print(sys.prefix, *sys.path[1:], sep=chr(10))"
    for word, path in _named(words, folder):
        if re.fullmatch(r"python[0-9.]*", path.name):
            # Not the file behind the link: by the link Python knows its virtual environment.
            program = os.fspath(folder / word) if "/" in word else word
            prefix, *places = run([program, "-c", code], time_limit=10.0, folder=folder).output.split("\n")
            yield word, [Path(one) for one in places if one], Path(prefix)


def _parts(words: Sequence[str]) -> list[str]:
    """The words, those of lines for a shell among them, and what stands behind a sign of equality."""
    every = (part for word in words for part in (word, *words_in(word)))
    parts = [re.sub(r"^~(?=/|$)", str(Path.home()), os.path.expandvars(part)) for part in every]
    return [*parts, *(part.partition("=")[2] for part in parts)]
