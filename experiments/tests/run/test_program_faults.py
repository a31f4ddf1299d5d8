"""The real program when something goes wrong around it: kills, full disks, locales, names of files."""

import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from experiments.tests.conftest import ROOT
from experiments.tests.small_disk import run_on_small_disk

PROGRAM = ROOT / "build" / "gcc" / "carom"
KILLS = 20

pytestmark = pytest.mark.skipif(
    not PROGRAM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)


def carom(*words: object, **options: object) -> "subprocess.CompletedProcess[str]":
    command = [str(PROGRAM), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)  # type: ignore[call-overload]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.in"
    assert carom("generate", 500, 500, 5, 40, -4, 4, "--output", path).returncode == 0
    return path


def test_kills_leave_whole_files_or_none(tmp_path: Path) -> None:
    scene, trajectory, record = tmp_path / "scene.in", tmp_path / "trajectory", tmp_path / "record.json"
    carom("generate", 500, 500, 5, 400, -4, 4, "--output", scene)
    began = time.monotonic()
    carom("run", scene, 1, "--trajectory", trajectory)
    seconds = time.monotonic() - began
    whole = trajectory.read_bytes()
    trajectory.unlink()
    moments = random.Random(20240301)
    killed = half_written = 0
    for turn in range(KILLS):
        words = ["run", scene, 1, "--trajectory", trajectory]
        if turn % 2:
            words = ["bench", scene, "--threads", 1, "--record", record]
        process = subprocess.Popen([str(PROGRAM), *map(str, words)], stdout=subprocess.DEVNULL)
        time.sleep(moments.uniform(0, seconds))
        process.kill()
        killed += process.wait() == -signal.SIGKILL
        for left in tmp_path.glob("*.part*"):
            half_written += 1
            left.unlink()
        assert not trajectory.exists() or trajectory.read_bytes() == whole
        assert not record.exists() or json.loads(record.read_text())["kind"] == "bench"
        trajectory.unlink(missing_ok=True)
        record.unlink(missing_ok=True)
    assert killed > 0, "some of the kills came in time"
    assert half_written > 0, "and some while a file was being written"


FULL = """
"$2" run "$3" --trajectory disk/trajectory; echo "code $?"
"$2" generate 5000 5000 5 40 -4 4 --output disk/scene.in; echo "code $?"
head -c 1m /dev/zero >disk/ballast 2>/dev/null
"$2" bench "$3" --record disk/record.json >/dev/null 2>said; code=$?; tail -n 1 said; echo "code $code"
rm disk/ballast
ls -A disk
"""


def test_a_full_disk_is_one_line_and_leaves_nothing(tmp_path: Path, scene: Path) -> None:
    said = run_on_small_disk(tmp_path / "disk", "64k", tmp_path, FULL, str(PROGRAM), str(scene)).splitlines()
    for file, place in zip(("trajectory", "scene.in", "record.json"), range(0, 6, 2), strict=True):
        assert said[place] == (
            f"carom: disk/{file}: writing broke off (No space left on device), "
            "expected a writable place with room"
        )
        assert said[place + 1] == "code 1"
    assert said[6:] == [], "nothing is left on the disk"


def test_a_file_that_may_not_grow_is_one_line_and_leaves_nothing(tmp_path: Path, scene: Path) -> None:
    target = tmp_path / "out" / "trajectory"
    target.parent.mkdir()
    done = carom(
        "run", scene, "--trajectory", target,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000)),
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        f"carom: {target}: writing broke off (File too large), expected a writable place with room"
    ]
    assert list(target.parent.iterdir()) == []


@pytest.fixture(scope="module")
def comma_locale(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of a German shell, whether or not the system has the locale ready."""
    folder = tmp_path_factory.mktemp("locales")
    if shutil.which("localedef") is None:
        pytest.skip("no locale can be made: localedef is not here")
    made = subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if made.returncode != 0:
        pytest.skip(f"no locale can be made: {made.stderr.strip()} (Debian: the package locales)")
    return {**os.environ, "LOCPATH": str(folder), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}


def test_more_discs_than_memory_is_one_line(tmp_path: Path) -> None:
    scene, trajectory = tmp_path / "many.in", tmp_path / "trajectory"
    assert carom("generate", 500_000, 10_000, 5, 1, 1, 2, "--output", scene).returncode == 0
    room = 60 << 20
    done = carom(
        "run", scene, 1, "--trajectory", trajectory,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (room, room)),
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr == "carom: out of memory: expected a machine with room for the scene and its boxes\n"
    assert sorted(tmp_path.iterdir()) == [scene]


def within(bytes_of_address_space: int) -> Callable[[], None]:
    """What limits a program before it starts."""
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (bytes_of_address_space,) * 2)


@pytest.mark.parametrize("variant", ["fastest", "published", "event_driven"])
def test_a_hundred_million_discs_that_do_not_fit_are_refused_before_they_are_read(
    tmp_path: Path, variant: str
) -> None:
    scene = tmp_path / "many.in"
    scene.write_text("100000000\n19817\n1\n1\n", encoding="utf-8")
    os.truncate(scene, 1 << 30)  # of nothing: no disc is read
    done = carom("run", scene, 2, "--variant", variant, preexec_fn=within(4 << 30))
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    # Of the four, the bytes of the file are taken already.
    assert re.match(
        r"carom: out of memory: found [23][0-9.]+ GiB free, expected at least [12][0-9.]+ GiB", line
    )
    assert line.endswith("for 100000000 discs on 2 threads")


def test_a_hundred_million_discs_that_do_not_fit_are_not_made(tmp_path: Path) -> None:
    done = carom(
        "generate", 100_000_000, 20_000, 1, 1, -1, 1, "--output", tmp_path / "many.in",
        preexec_fn=within(4 << 30),
    )  # fmt: skip
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith("carom: out of memory: ")
    assert line.endswith("100000000 discs and their text")
    assert list(tmp_path.iterdir()) == []


def test_more_threads_than_their_stacks_have_room_for_are_one_line(tmp_path: Path) -> None:
    scene = tmp_path / "few.in"
    assert carom("generate", 1000, 200, 1, 1, 1, 2, "--output", scene).returncode == 0
    stack = resource.getrlimit(resource.RLIMIT_STACK)[0]
    if stack == resource.RLIM_INFINITY or stack < 1 << 20:
        pytest.skip("no usual limit of a stack here")
    unset = {name: text for name, text in os.environ.items() if not name.endswith("_STACKSIZE")}
    done = carom("run", scene, 1024, preexec_fn=within(500 * stack), env=unset)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith("carom: --threads: found 1024, whose stacks of ")


def test_the_locale_has_a_decimal_comma(comma_locale: dict[str, str]) -> None:
    code = "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.localeconv()['decimal_point'])"
    done = subprocess.run(
        ["python3", "-c", code], env=comma_locale, capture_output=True, text=True, check=True
    )
    assert done.stdout == ",\n"


def test_a_locale_with_decimal_commas_changes_nothing(
    tmp_path: Path, scene: Path, comma_locale: dict[str, str]
) -> None:
    numbers = ("generate", 50, "100.5", "1.25", 3, "-0.5", "0.5")
    assert carom(*numbers, env=comma_locale).stdout == carom(*numbers).stdout
    states = [
        json.loads(carom("run", scene, "--json", env=environment).stdout)["state_hash"]
        for environment in (comma_locale, None)
    ]
    assert states[0] == states[1]
    record = tmp_path / "record.json"
    carom("bench", scene, "--record", record, "--tag", "x=1.5", env=comma_locale)
    assert json.loads(record.read_text())["contenders"][0]["tags"]["x"] == 1.5
    refused = carom("generate", 50, "100,5", "1,25", 3, 0, 1, env=comma_locale)
    assert (refused.returncode, len(refused.stderr.splitlines())) == (1, 1)


@pytest.mark.parametrize("name", ["with spaces", 'it\'s "quoted"', "$(reboot); `x` & *", "--help", "é 中\n2"])
def test_any_name_does_for_a_file(tmp_path: Path, scene: Path, name: str) -> None:
    awkward = tmp_path / f"{name}.in"
    shutil.copy(scene, awkward)
    trajectory, record = tmp_path / f"{name}.trajectory", tmp_path / f"{name}.json"
    assert carom("run", awkward, "--trajectory", trajectory).returncode == 0
    assert trajectory.stat().st_size > 0
    assert carom("bench", awkward, "--record", record).returncode == 0
    assert json.loads(record.read_text())["contenders"][0]["scene"]["name"] == awkward.name
