"""What may go wrong around a study: full disks, folders that cannot be written, awkward names, damaged files.

Kills are in test_kill.py, locks and signals in test_command_line.py, stale programs in test_run.py.
"""

import os
import re
import sys
from pathlib import Path

import pytest

from experiments.run.session import run
from experiments.tests.conftest import CONTROL, DAMAGES, PAIR, ROOT, Workplace, damage, finish
from experiments.tests.small_disk import run_on_small_disk

# With its source named, the second mount does not repeat the first one's options, among them an owner whom
# the namespace of an ordinary user does not know.
FULL = """
run() {
    PYTHONPATH="$3" "$2" -m experiments run --results results --build build --questions questions --no-figures
}
run "$@" 2>said; echo "code $?"; sed 's/^/said: /' said
find results -name '*.json' ! -exec "$2" -m json.tool {} /dev/null \\; -printf 'torn: %p\\n'
mount -o remount,size=10m none results && run "$@"; echo "code $?"
find results/records -name '*.json' | wc -l
"""


@pytest.mark.parametrize("size", ["4k", "40k", "64k"])
def test_a_full_disk_is_one_line_and_with_room_the_study_goes_on(workplace: Workplace, size: str) -> None:
    said = run_on_small_disk(workplace.results, size, workplace.root, FULL, sys.executable, str(ROOT))
    assert "Traceback" not in said
    assert "torn" not in said
    first, second = re.findall(r"^code (\d+)$", said, re.MULTILINE)
    assert first in ("1", "2"), said
    lines = re.findall(r"^said: (.*)$", said, re.MULTILINE)
    assert len(lines) == 1, said
    assert "No space left on device" in lines[0]
    assert second == "0", said
    assert said.splitlines()[-1] == "7", "all that was missing was measured"


FULL_WHILE_DRAWING = """
export PYTHONPATH="$3"
"$2" -m experiments run --results results --build build --questions questions --no-figures || exit
"$2" -m analysis figures --results results >/dev/null || exit
sha256sum results/figures/* >before
head -c 10m /dev/zero >results/ballast 2>/dev/null
for verb in figures report; do
    "$2" -m analysis $verb --results results 2>said; echo "code $?"
    sed 's/^/said: /' said
    sha256sum results/figures/* >after; cmp before after && echo as it was
done
find results -name '*.part*'
"""


def test_a_disk_that_is_full_while_drawing_keeps_the_figures_of_before(workplace: Workplace) -> None:
    words = (sys.executable, str(ROOT))
    said = run_on_small_disk(workplace.results, "10m", workplace.root, FULL_WHILE_DRAWING, *words)
    told = r"carom: results/\S+: No space left on device, expected a writable place with room"
    of_each = rf"code 1\nsaid: {told}\nas it was\n"
    assert len(re.findall(rf"^{of_each}", said, re.MULTILINE)) == 2, said
    assert said.endswith("as it was\n"), said


def not_writable(folder: Path) -> dict[str, Path]:
    (folder / "file").touch()
    (folder / "closed").mkdir(mode=0o555)
    return {
        "below a file": folder / "file" / "results",
        "a file": folder / "file",
        "in a folder of the system": Path("/proc/carom"),
        "in a closed folder": folder / "closed" / "results",
    }


@pytest.mark.parametrize(
    "where", ["below a file", "a file", "in a folder of the system", "in a closed folder"]
)
def test_a_results_folder_that_cannot_be_written_is_one_line(workplace: Workplace, where: str) -> None:
    if where == "in a closed folder" and os.geteuid() == 0:
        pytest.skip("root may write into any folder")
    results = not_writable(workplace.root)[where]
    code, output, error = finish(workplace.start("run", "--results", str(results)))
    assert code == 1
    assert output == ""
    (line,) = error.splitlines()
    if where.endswith("a file"):
        found = f"results: found {workplace.root / 'file'}, which is no folder, expected one or a place for "
        assert line.startswith(f"carom: {found}")
    else:
        assert line.startswith(f"carom: {results}")
        assert "expected a writable place" in line


NAMES = ["it's a 'place' with \"quotes\", $HOME; `exit 3` & * ?", "-dash é ü 中"]


@pytest.mark.parametrize("name", NAMES)
def test_any_name_does_for_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    place = Workplace(tmp_path / name, monkeypatch)
    place.root.mkdir()
    place.build()
    place.question("pair", PAIR)
    place.question("control", CONTROL)
    code, _, error = finish(place.start("run", "--no-figures", f"--results=./{name}"))
    assert (code, error) == (0, "")
    assert len(list((place.root / name).glob("records/*/*/*.json"))) == 5


@pytest.mark.parametrize("kind", DAMAGES)
def test_a_damaged_record_is_put_aside_and_measured_again(workplace: Workplace, kind: str) -> None:
    assert run(workplace.settings) == 0
    victim = workplace.files("pair")[0]
    damage(victim, kind)
    row = workplace.rows()["pair"]
    assert (row.stale, row.done, row.missing) == (1, 2, 2)
    assert run(workplace.settings) == 0
    assert workplace.rows()["pair"].done == 4
    assert os.path.lexists(workplace.results / "stale" / victim.relative_to(workplace.results))
