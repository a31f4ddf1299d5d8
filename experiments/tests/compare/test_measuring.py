"""How `carom compare` measures: what is run before, after and between, how often, and for how long."""

import json
from pathlib import Path

from experiments.tests.compare.calls import LOOP, TOOK, needs_the_program, run, script

pytestmark = needs_the_program


def test_before_and_after_each_run_and_once_for_all(folder: Path) -> None:
    script(folder / "needs", 'test -e prepared && test -e set_up && test "$A" = 1 && read x && test $x = y')
    (folder / "input").write_text("y\n", encoding="utf-8")
    done = run(
        folder, "compare", "-n", "a", "-n", "b", "./needs", "./needs", "--time", "1ms",
        "--prepare", "touch prepared", "--conclude", "rm prepared", "--setup", "touch set_up",
        "--cleanup", "rm set_up; touch cleaned_up", "--input", "input", "--env", "A=1", "--turns", "off",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not (folder / "set_up").exists()
    assert not (folder / "prepared").exists()
    assert (folder / "cleaned_up").exists()


def test_what_once_comes_first_and_fails_is_said(folder: Path) -> None:
    done = run(folder, "compare", "./short", "./long", "--setup", "echo no room >&2; false")
    assert done.returncode == 1
    assert "carom: --setup: " in done.stderr
    assert "no room" in done.stderr


def test_threads_are_bound_or_the_environment_is_the_users(folder: Path) -> None:
    for words, env, wanted in (
        (["--threads", "1"], {"OMP_NUM_THREADS": "7"}, "1"),
        ([], {"OMP_NUM_THREADS": "7"}, "7"),
    ):
        script(folder / "threads", f'test "$OMP_NUM_THREADS" = {wanted}')
        done = run(folder, "compare", "./short", "./threads", "--time", "1ms", *words, env=env)
        assert done.returncode == 0, done.stderr


def test_the_layout_varies_from_block_to_block_or_is_fixed(folder: Path) -> None:
    script(folder / "tells", 'echo "${#CAROM_PADDING}" >> paddings; echo took 50 ms')
    words = ("compare", "echo took 100 ms", "./tells", *TOOK, "--time", "20s")
    assert run(folder, *words).returncode == 0
    paddings = (folder / "paddings").read_text(encoding="utf-8").split()
    assert len(set(paddings)) > 1
    (folder / "paddings").unlink()
    assert run(folder, *words, "--fixed-layout").returncode == 0
    assert set((folder / "paddings").read_text(encoding="utf-8").split()) == {"0"}


def test_a_smaller_error_is_stated_and_takes_more(folder: Path) -> None:
    script(folder / "wobbles", 'echo took "$((100 + $(wc -l < blocks) % 3))" ms; echo x >> blocks')
    script(folder / "longer", 'echo took "$((104 + $(wc -l < blocks) % 3))" ms; echo x >> blocks')
    needed = {}
    for error in ("5%", "0.01%"):
        (folder / "blocks").write_text("", encoding="utf-8")
        words = ("./wobbles", "./longer", *TOOK, "--error", error, "--time", "60s", "--export-json", "a.json")
        run(folder, "compare", *words)
        told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
        [one] = told["differences"]
        needed[error] = told["blocks"], one["high"] - one["low"]
        assert told["error"] == float(error.removesuffix("%")) / 100
    assert needed["0.01%"] > needed["5%"]


def test_untimed_runs_come_before_each_timed_one(folder: Path) -> None:
    script(folder / "counts", "echo x >> runs")
    words = ("--warmup", "2", "--prepare", "true", "--turns", "off", "--time", "1ms")
    assert run(folder, "compare", "-n", "a", "-n", "b", "./counts", "./counts", *words).returncode == 0
    # Two commands and the control, in one block.
    assert (folder / "runs").read_text(encoding="utf-8").count("x") == 3 * (2 + 1)


def test_short_commands_are_repeated(folder: Path) -> None:
    script(folder / "quick", "echo x >> runs")
    script(folder / "quicker", "exit 0")
    files = ("--export-json", "a.json")
    done = run(folder, "compare", "./quick", "./quicker", "--time", "1s", "--turns", "off", *files)
    assert done.returncode in (0, 5), done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    often = told["rounds"][0]
    assert often > 1
    assert f"none of them stopped: quick {often}, quicker " in done.stdout
    # Itself and under its second name: once in the block that shows how short it is.
    runs = (folder / "runs").read_text(encoding="utf-8").count("x")
    blocks = sum(len(one["blocks"]) for one in told["runs"] if one["command"].startswith("quick"))
    of_quicker = sum(len(one["blocks"]) for one in told["runs"] if one["command"] == "quicker")
    assert runs == 2 + often * (blocks - of_quicker)
    assert told["runs"][0]["exit_codes"] == {"0": often * told["blocks"]}


def test_a_short_command_that_fails_is_named_with_its_code(folder: Path) -> None:
    script(folder / "quick", "exit 0")
    script(
        folder / "wears_out", 'echo x >> count; [ "$(wc -l < count)" -lt 9 ] || { echo worn >&2; exit 4; }'
    )
    done = run(folder, "compare", "./quick", "./wears_out", "--time", "20s", "--turns", "off")
    assert done.returncode == 2
    assert "exit code 4: worn" in done.stderr


def test_what_is_short_is_prepared_before_each_run(folder: Path) -> None:
    script(folder / "needs", "rm prepared")
    words = ("--prepare", "touch prepared", "--turns", "off", "--time", "1s", "--export-json", "a.json")
    done = run(folder, "compare", "-n", "a", "-n", "b", "./needs", "./needs", *words)
    assert done.returncode in (0, 5), done.stderr
    assert json.loads((folder / "a.json").read_text(encoding="utf-8"))["rounds"][0] > 1


def test_slices_are_as_long_as_asked(folder: Path) -> None:
    slices = {}
    for length in ("5ms", "10s"):
        words = ("./long", "./long; true", "--turns", length, "--time", "1ms", "--append", length)
        assert run(folder, "compare", *words).returncode == 0
        [session] = json.loads((folder / length).read_text(encoding="utf-8"))["sessions"]
        contenders = [contender for one in session["records"] for contender in one["contenders"]]
        slices[length] = [len((one["slices"] or {"seconds": []})["seconds"]) for one in contenders]
    assert max(slices["5ms"]) > max(slices["10s"])


def test_if_one_must_not_be_stopped_none_is(folder: Path) -> None:
    script(folder / "far_longer_than_a_slice", LOOP.format(times=60_000))
    words = ("-n", "works", "-n", "sleeps", "--time", "8s", "--append", "kept.json")
    done = run(folder, "compare", *words, "--", "./far_longer_than_a_slice", "--vs", "sleep", "0.2")
    assert done.returncode in (0, 5), done.stderr
    [session] = json.loads((folder / "kept.json").read_text(encoding="utf-8"))["sessions"]
    contenders = [contender for one in session["records"] for contender in one["contenders"]]
    assert {one["tags"]["series"] for one in contenders} == {"works", "works again", "sleeps"}
    assert not any(one["slices"] for one in contenders)
    assert "never stopped: " in done.stdout, "of whom and why depends on how busy the machine is"
