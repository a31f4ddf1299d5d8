"""What the code weighs: lines that say something. The sums may shrink; who adds to them sees it here."""

import ast
import re
import subprocess
from pathlib import PurePosixPath

import pytest
from documents import ROOT

CODE, TESTS = 24_304, 19_364
"""The most lines of code, and of tests; less of either is for the better, and lowers the number here."""

_SAYS_NOTHING = re.compile(
    r"[\s{}()\[\];,]*|\s*(//|#\s*(include|pragma)|(using )?namespace\b|(public|private|protected):).*"
)
_COMMENTS = re.compile(r"/\*.*?\*/|(?<!:)//[^\n]*", re.DOTALL)


def weight(name: str, text: str) -> int:
    """Lines without blank ones, comments, docstrings, imports and brackets alone."""
    lines = text.splitlines()
    if name.endswith(".py"):
        frame = [node for node in ast.walk(ast.parse(text)) if _is_frame(node)]
        spans = {line for node in frame for line in range(node.lineno, (node.end_lineno or 0) + 1)}
        lines = [line for at, line in enumerate(lines, 1) if at not in spans and line.lstrip()[:1] != "#"]
    else:
        lines = _COMMENTS.sub("", text).splitlines()
    return sum(not _SAYS_NOTHING.fullmatch(line) for line in lines)


def _is_frame(node: ast.AST) -> bool:
    is_text = isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)
    return isinstance(node, ast.Import | ast.ImportFrom) or is_text


def test_a_line_counts_if_it_says_something() -> None:
    python = '"""A page."""\nimport os\n\n# why\nONE = (\n    os.sep,  # why\n)\n"""Of it."""\n'
    assert weight("a.py", python) == 2
    cpp = (
        '#include <a>\nnamespace b {\n/* why\n   not */\nint c(); // "d"\n}\npublic:\nauto e = "http://f";\n'
    )
    assert weight("a.cpp", cpp) == 2


@pytest.mark.parametrize(("is_test", "most"), [(False, CODE), (True, TESTS)])
def test_the_sum_holds(is_test: bool, most: int) -> None:
    listed = subprocess.run(["git", "-C", ROOT, "ls-files"], capture_output=True, text=True, check=True)
    names = [PurePosixPath(name) for name in listed.stdout.splitlines()]
    files = [
        name
        for name in names
        if name.suffix in {".cpp", ".hpp", ".h", ".c", ".py"} and (ROOT / name).exists()
    ]
    chosen = [name for name in files if ("tests" in name.parts or name.name == "conftest.py") == is_test]
    weights = {str(name): weight(name.name, (ROOT / name).read_text(encoding="utf-8")) for name in chosen}
    assert sum(weights.values()) <= most, f"{sum(weights.values())} lines"
