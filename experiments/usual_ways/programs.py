"""Programs that are equal, or of which one does so much more work, by construction."""

import subprocess
from pathlib import Path

_SOURCE = """#include <cstdlib>
int main(int, char** words) {
    volatile double sum = 0;
    for (long left = std::atol(words[1]); left > 0; --left) {
        sum = sum + 1.0 / static_cast<double>(left);
    }
    return sum > 0 ? 0 : 1;
}
"""
"""A loop of divisions: it takes as much longer as it has more turns."""

TURNS = 40_000_000
"""Of the loop: a tenth of a second or more on a machine of today."""


def build_loop(folder: Path) -> Path:
    """Compile the loop into a folder; returns the program, whose one argument is the number of turns."""
    source, program = folder / "loop.cpp", folder / "loop"
    source.write_text(_SOURCE, encoding="utf-8")
    subprocess.run(["c++", "-O2", "-o", program, source], check=True)
    return program


def pair(program: Path, more: float) -> tuple[list[str], list[str]]:
    """The words of two runs, of which the second has so much more work, as a fraction."""
    return [str(program), str(TURNS)], [str(program), str(round(TURNS * (1 + more)))]
