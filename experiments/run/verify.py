"""The steps of a variant checked, each of them, before anything of it is timed; or after it what was."""

import json
from pathlib import Path

from experiments.plan.point import Point
from experiments.plan.program import CHECK_FAILED, Program, check_command
from experiments.plan.scenes import SceneFile
from experiments.results.store import Store
from experiments.run.host_lock import run_alone
from experiments.run.processes import Processes
from experiments.support.digest import digest
from experiments.support.process import TIMED_OUT, Completed

CRASHED = 1
"""Of a program whose own exit code would be taken for a failed check."""


class Verifier:
    """Runs `carom check`, once for each program, variant, tolerance and scene; verdicts are kept."""

    def __init__(self, store: Store, checker: Program, processes: Processes, time_limit: float) -> None:
        """The checker is the program that looks at what other programs write."""
        self._store = store
        self._checker = checker
        self._processes = processes
        self._time_limit = time_limit
        self._own_checked: set[str] = set()

    def check(self, point: Point, scene: SceneFile) -> Completed:
        """The verdict on the point's variant on that scene: exit code 0 if each of its steps passed."""
        kept = _verdict(self._store.note(note_of(point, scene)))
        if kept is not None:
            return kept
        done = self._run(point, scene) if point.command is None else self._check_trajectory(point, scene)
        reason = "" if done.exit_code == 0 else f"check of each step: {done.reason}"
        if done.exit_code in (0, CHECK_FAILED):
            verdict = {"command": list(done.command), "exit_code": done.exit_code, "reason": reason}
            self._store.keep_note(note_of(point, scene), verdict)
        said = reason if done.exit_code != TIMED_OUT else done.error
        return Completed(done.command, done.exit_code, "", said)

    def check_own_output(self, point: Point, scene: SceneFile, output: Path) -> Completed | None:
        """The verdict on the trajectory that the timed run itself wrote, once in a session; None for what was
        found right in it before.
        """
        if point.id in self._own_checked:
            return None
        done = self._look_at(output, scene, point)
        if done.exit_code == 0:
            self._own_checked.add(point.id)
            return None
        said = done.error if done.exit_code == TIMED_OUT else f"check of its own output: {done.reason}"
        return Completed(done.command, done.exit_code, "", said)

    def _run(self, point: Point, scene: SceneFile) -> Completed:
        what = (point.threads, "--variant", point.variant)
        command = check_command(point.program, scene.path, point.tolerance, *what)
        return run_alone(command, point.openmp, self._time_limit)

    def _check_trajectory(self, point: Point, scene: SceneFile) -> Completed:
        """Of another program: what it writes, once and untimed."""
        output = self._store.temporary.absolute() / "trajectory"
        output.unlink(missing_ok=True)
        done = self._processes.write_trajectory(point, scene.path.absolute(), output)
        if done.exit_code != 0:
            return Completed(done.command, CRASHED, "", done.reason)
        checked = self._look_at(output, scene, point)
        output.unlink(missing_ok=True)
        return checked

    def _look_at(self, output: Path, scene: SceneFile, point: Point) -> Completed:
        command = check_command(self._checker, scene.path, point.tolerance, "--trajectory", output)
        if not output.is_file():
            return Completed(command, CRASHED, "", f"left no trajectory in {output}")
        return run_alone(command, (), self._time_limit)


def _verdict(kept: object) -> Completed | None:
    """The verdict that was kept; None where there is none, or something else in its place."""
    match kept:
        case {"command": [*command], "exit_code": int(exit_code), "reason": str(reason)}:
            return Completed(tuple(map(str, command)), exit_code, "", reason)
    return None


def note_of(point: Point, scene: SceneFile) -> str:
    """The name under which the verdict on a variant, a tolerance and a scene is kept."""
    content = f"{point.program.sha256} {point.variant} {point.tolerance} {scene.sha256}"
    if point.command is not None:
        checker = point.command.checker
        content += json.dumps(
            [point.command.trajectory, point.command.instrument, checker.sha256 if checker else None]
        )
    return f"checks/{digest(content)}.json"
