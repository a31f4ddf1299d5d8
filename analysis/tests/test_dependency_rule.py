"""Who may know whom: the rule of README.md's table of folders, and of each folder's own table of rooms.

All of it is checked over the whole tree.

Each rule is also shown to fail: on a tree of a few files in which it is broken.
"""

import ast
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

MAY_INCLUDE = {
    "kernels": {"kernels"},
    "variants": {"kernels", "variants"},
    "harness": {"kernels", "variants", "harness"},
}
MUST_NOT_IMPORT = {
    "experiments": {"docs"},
    "analysis": {"experiments", "docs"},
    "support": {"analysis", "experiments", "docs"},
}
GENERATED = {"harness/machine/build_info.hpp"}
PRAGMAS = "kernels/parallel_for.hpp"
FOLDERS_WITH_ROOMS = ("kernels", "harness", "experiments", "analysis")
MOST_FILES = 25
"""Source files in one room: more are a wall."""

NO_HEADER_OF_A_KERNEL = {
    "chrono", "cstdio", "cstdlib", "ctime", "filesystem", "fstream", "iostream", "mutex", "print",
    "sstream", "stdio.h", "stdlib.h", "sys/time.h", "syncstream", "thread", "time.h", "unistd.h",
}  # fmt: skip
"""Input and output, clocks, ends of the process, threads beside OpenMP's."""

NO_WORD_OF_A_KERNEL = re.compile(
    r"\bstd::c(?:out|err|log|in)\b|::time\s*\(|\b(?:steady|system|high_resolution)_clock\b|"
    r"\b(?:f?printf|puts|fopen|exit|_Exit|quick_exit|abort|terminate|getenv|system|omp_get_wtime|"
    r"clock_gettime|gettimeofday|__rdtsc)\s*\("
)


@pytest.mark.parametrize("folder", FOLDERS_WITH_ROOMS)
def test_a_folder_names_its_rooms_where_it_begins(folder: str) -> None:
    assert len(rooms(ROOT / folder)) > 1


Rule = Callable[[Path], Iterator[str]]


def wrong_includes(root: Path) -> Iterator[str]:
    """Quoted includes that point to a folder that may not be known, or to no file."""
    for name, text in cpp_files(root):
        folder = name.split("/")[0]
        for target in includes(root, name, text):
            if target.split("/")[0] not in MAY_INCLUDE[folder] or ".." in target:
                yield f"{name}: includes {target}"
            elif not (root / target).is_file() and target not in GENERATED:
                yield f"{name}: includes {target}, which there is not"


def includes(root: Path, name: str, text: str) -> Iterator[str]:
    """What a C++ file includes in quotes, from the root."""
    for included in re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.MULTILINE):
        beside = (root / name).parent / included
        yield f"{Path(name).parent.as_posix()}/{included}" if beside.is_file() else included


def wrong_rooms(root: Path) -> Iterator[str]:
    """Files in rooms that their folder's README does not name, uses of rooms further down in its table."""
    order = {folder: rooms(root / folder) for folder in FOLDERS_WITH_ROOMS}
    for name, used in uses(root):
        folder = name.split("/")[0]
        if not order.get(folder) or "/tests/" in name:
            continue
        here = room_of(name)
        if here != "." and here not in order[folder]:
            yield f"{name}: stands in a room that {folder}/README.md does not name"
            continue
        # What stands beside the rooms, outside the table, is where the program starts: it may use all.
        reach = order[folder].index(here) if here in order[folder] else len(order[folder])
        for target in used:
            there = room_of(target)
            if target.split("/")[0] == folder and there != here and there not in order[folder][:reach]:
                yield f"{name}: uses {target}"


def rooms(folder: Path) -> list[str]:
    """A folder's rooms as the table in its README has them: each may use those before it."""
    readme = folder / "README.md"
    text = readme.read_text(encoding="utf-8") if readme.is_file() else ""
    table = re.search(r"^\| room \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", text, re.MULTILINE)
    return re.findall(r"^\| `([\w.]+)/?` \|", table[1], re.MULTILINE) if table else []


def room_of(name: str) -> str:
    """The room in which a file stands; a dot for what stands in none."""
    parts = name.split("/")
    return parts[1] if len(parts) > 2 else "."


def uses(root: Path) -> Iterator[tuple[str, list[str]]]:
    """Every source file with the paths, from the root, of what it includes or imports."""
    for name, text in cpp_files(root):
        yield name, list(includes(root, name, text))
    for name, imported in python_files(root):
        modules = ("/".join(one.split(".")[:2]) + end for one in imported for end in ("/", ".py"))
        yield name, [module for module in modules if (root / module).exists()]


def walls(root: Path) -> Iterator[str]:
    """Rooms with too many source files, and rooms of more than a handful that do not say what is in them."""
    for folder in FOLDERS_WITH_ROOMS:
        for room in {path.parent for path in (root / folder).rglob("*.*") if "tests" not in path.parts}:
            files = [path for path in room.iterdir() if path.suffix in (".hpp", ".cpp", ".py")]
            name = room.relative_to(root).as_posix()
            if len(files) > MOST_FILES:
                yield f"{name}: has {len(files)} source files"
            said = room / "__init__.py"
            header = said.is_file() and ast.get_docstring(ast.parse(said.read_text(encoding="utf-8")))
            if len(files) > 6 and not header and not (room / "README.md").is_file():
                yield f"{name}: does not say what is in it"


def wrong_imports(root: Path) -> Iterator[str]:
    """Imports of a Python package in one that must not know it, wherever in a file they stand."""
    for name, imported in python_files(root):
        others = MUST_NOT_IMPORT[name.split("/")[0]]
        yield from (f"{name}: imports {one}" for one in imported if one.split(".")[0] in others)


def python_files(root: Path) -> Iterator[tuple[str, list[str]]]:
    """Name of every Python file, with the modules that it names."""
    for folder in MUST_NOT_IMPORT:
        for path in sorted((root / folder).rglob("*.py")):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            yield path.relative_to(root).as_posix(), list(imports(tree))


def imports(tree: ast.AST) -> Iterator[str]:
    """The modules that a file names: in statements, and in calls of importlib's and pytest's functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in ("import_module", "importorskip", "__import__"):
                yield str(node.args[0].value)


def stray_pragmas(root: Path) -> Iterator[str]:
    """OpenMP pragmas outside the one file that may have them."""
    for name, text in cpp_files(root):
        if name != PRAGMAS and re.search(r'#\s*pragma\s+omp|_Pragma\s*\(\s*"\s*omp', text):
            yield f"{name}: has an OpenMP pragma"


def unclean_kernels(root: Path) -> Iterator[str]:
    """Kernels' headers that print, read, exit, start threads or look at a clock."""
    for name, text in cpp_files(root):
        if not name.startswith("kernels/") or name.startswith("kernels/tests/"):
            continue
        headers = re.findall(r"^\s*#\s*include\s*<([^>]+)>", text, re.MULTILINE)
        yield from (f"{name}: includes <{one}>" for one in headers if one in NO_HEADER_OF_A_KERNEL)
        yield from (f"{name}: says {found.group()}" for found in NO_WORD_OF_A_KERNEL.finditer(text))


def cpp_files(root: Path) -> Iterator[tuple[str, str]]:
    """Name and text of every C++ file, comments taken out."""
    for folder in MAY_INCLUDE:
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            yield path.relative_to(root).as_posix(), without_comments(path.read_text(encoding="utf-8"))


def without_comments(text: str) -> str:
    """The text without comments; a string that holds what looks like one is left as it is."""
    pattern = r'("(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\')|//[^\n]*|/\*.*?\*/'
    return re.sub(pattern, lambda found: found.group(1) or " ", text, flags=re.DOTALL)


BROKEN: list[tuple[Rule, str, str, str]] = [
    (wrong_includes, "kernels/a.hpp", '#include "harness/text.hpp"', "kernels/a.hpp: includes harness/text"),
    (wrong_includes, "kernels/a.hpp", '#include "../harness/text.hpp"', "kernels/a.hpp: includes ../harness"),
    (wrong_includes, "kernels/tests/a.cpp", '#include "variants/name.hpp"', "kernels/tests/a.cpp: includes"),
    (wrong_includes, "variants/a.hpp", ' # include "harness/text.hpp"', "variants/a.hpp: includes harness"),
    (wrong_includes, "harness/a.hpp", '#include "analysis/a.hpp"', "harness/a.hpp: includes analysis/a.hpp"),
    (wrong_includes, "harness/a.cpp", '#include "harness/gone.hpp"', "harness/a.cpp: includes harness/gone"),
    (wrong_imports, "analysis/a.py", "import experiments.plan as plan", "analysis/a.py: imports experiments"),
    (wrong_imports, "analysis/tests/a.py", "if 1:\n from experiments import plan", "tests/a.py: imports"),
    (wrong_imports, "analysis/a.py", "importlib.import_module('experiments')", "analysis/a.py: imports"),
    (wrong_imports, "support/a.py", "from analysis.support import wording", "support/a.py: imports analysis"),
    (wrong_imports, "experiments/a.py", "from docs.generate import pages", "a.py: imports docs.generate"),
    (wrong_rooms, "harness/support/a.hpp", '#include "harness/scenes/b.hpp"', "a.hpp: uses harness/scenes"),
    (wrong_rooms, "harness/scenes/a.hpp", '#include "harness/main.hpp"', "scenes/a.hpp: uses harness/main"),
    (wrong_rooms, "harness/attic/a.hpp", "", "harness/attic/a.hpp: stands in a room that harness/README.md"),
    (wrong_rooms, "kernels/a.hpp", '#include "kernels/exact/b.hpp"', "a.hpp: uses kernels/exact/b"),
    (wrong_rooms, "analysis/support/a.py", "from analysis import figures", "analysis/support/a.py: uses"),
    (wrong_rooms, "analysis/support/a.py", "from analysis.cli import main", "a.py: uses analysis/cli.py"),
    (stray_pragmas, "kernels/move.hpp", "#pragma omp parallel", "kernels/move.hpp: has an OpenMP pragma"),
    (stray_pragmas, "harness/a.cpp", '_Pragma("omp simd")', "harness/a.cpp: has an OpenMP pragma"),
    (unclean_kernels, "kernels/a.hpp", "#include <iostream>", "kernels/a.hpp: includes <iostream>"),
    (unclean_kernels, "kernels/a.hpp", "void f() { std::cout << 1; }", "kernels/a.hpp: says std::cout"),
    (unclean_kernels, "kernels/a.hpp", "void f() { std::exit(1); }", "kernels/a.hpp: says exit("),
    (unclean_kernels, "kernels/a.hpp", "auto f() { return std::time(nullptr); }", "says ::time("),
    (unclean_kernels, "kernels/a.hpp", "double f() { return omp_get_wtime(); }", "says omp_get_wtime("),
    (unclean_kernels, "kernels/a.hpp", "auto f = std::chrono::steady_clock::now();", "says steady_clock"),
]


RULES = (wrong_includes, wrong_imports, wrong_rooms, stray_pragmas, unclean_kernels)


@pytest.mark.parametrize("rule", [*RULES, walls])
def test_no_rule_is_broken(rule: Rule) -> None:
    assert list(rule(ROOT)) == []


def test_the_openmp_pragmas_stand_in_their_file() -> None:
    assert len(re.findall(r"#pragma omp", (ROOT / PRAGMAS).read_text(encoding="utf-8"))) > 5


def small_house(root: Path) -> None:
    """Two rooms in three of the folders; one is as full as it may be."""
    for folder, first, second in [("harness", "support", "scenes"), ("analysis", "support", "figures")]:
        for room in (first, second):
            (root / folder / room).mkdir(parents=True)
        table = f"| room | what |\n|---|---|\n| `{first}/` | |\n| `{second}/` | |\n"
        (root / folder / "README.md").write_text(table, encoding="utf-8")
    (root / "analysis" / "cli.py").touch()
    (root / "harness" / "scenes" / "b.hpp").touch()
    (root / "kernels" / "exact").mkdir(parents=True)
    (root / "kernels" / "exact" / "b.hpp").touch()
    table = "| room | what |\n|---|---|\n| `.` | |\n| `exact/` | |\n"
    (root / "kernels" / "README.md").write_text(table, encoding="utf-8")


@pytest.mark.parametrize(("rule", "name", "text", "said"), BROKEN)
def test_a_broken_rule_is_found(tmp_path: Path, rule: Rule, name: str, text: str, said: str) -> None:
    small_house(tmp_path)
    path = tmp_path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text + "\n", encoding="utf-8")
    (found,) = rule(tmp_path)
    assert said in found


def test_a_wall_is_found(tmp_path: Path) -> None:
    small_house(tmp_path)
    room = tmp_path / "harness" / "support"
    for number in range(7):
        (room / f"{number}.hpp").touch()
    assert list(walls(tmp_path)) == ["harness/support: does not say what is in it"]
    (room / "README.md").touch()
    assert list(walls(tmp_path)) == []
    for number in range(7, MOST_FILES + 1):
        (room / f"{number}.cpp").touch()
    assert list(walls(tmp_path)) == [f"harness/support: has {MOST_FILES + 1} source files"]


@pytest.mark.parametrize("rule", RULES)
def test_what_a_comment_says_breaks_no_rule(tmp_path: Path, rule: Rule) -> None:
    (tmp_path / "kernels").mkdir()
    text = '// #include "harness/text.hpp"\n/* #pragma omp parallel\n std::exit(1) */\n'
    (tmp_path / "kernels" / "a.hpp").write_text(text, encoding="utf-8")
    assert list(rule(tmp_path)) == []
