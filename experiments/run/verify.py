"""The steps of a variant checked, each of them, before anything of it is timed."""

from dataclasses import replace

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.plan.program import CHECK_FAILED, check_command
from experiments.plan.scenes import HardCase, SceneFile
from experiments.results.store import Store
from experiments.run.host_lock import run_alone
from experiments.support.digest import digest
from experiments.support.process import TIMED_OUT, Completed

CHECKED_STEPS = 20
"""How many steps of a generated scene are checked, each of them; of a hard case all are."""


def representative(experiment: Experiment, point: Point) -> Point:
    """What the variant is checked on: the beginning of the first scene with that variant and scene's name.

    Checking a step costs as much as several, so neither every scene of a sweep nor every step is checked; the
    program checks the last step of each timed run besides.
    """
    same = (point.program, point.variant, point.scene_name)
    first = next(
        other for other in experiment.points if (other.program, other.variant, other.scene_name) == same
    )
    if isinstance(first.scene, HardCase):
        return first
    return replace(first, scene=replace(first.scene, steps=min(first.scene.steps, CHECKED_STEPS)))


class Verifier:
    """Runs `carom check`, once for each program, variant, tolerance and scene; verdicts are kept."""

    def __init__(self, store: Store, time_limit: float) -> None:
        self._store = store
        self._time_limit = time_limit

    def check(self, point: Point, scene: SceneFile) -> Completed:
        """The verdict on the point's variant on that scene: exit code 0 if each of its steps passed."""
        kept = _verdict(self._store.note(note_of(point, scene)))
        if kept is not None:
            return kept
        command = check_command(point.program, scene.path, point.variant, point.threads, point.tolerance)
        done = run_alone(command, point.openmp, self._time_limit)
        reason = "" if done.exit_code == 0 else f"check of each step: {done.reason}"
        if done.exit_code in (0, CHECK_FAILED):
            verdict = {"command": list(command), "exit_code": done.exit_code, "reason": reason}
            self._store.keep_note(note_of(point, scene), verdict)
        return Completed(command, done.exit_code, "", reason if done.exit_code != TIMED_OUT else done.error)


def _verdict(kept: object) -> Completed | None:
    """The verdict that was kept; None where there is none, or something else in its place."""
    match kept:
        case {"command": [*command], "exit_code": int(exit_code), "reason": str(reason)}:
            return Completed(tuple(map(str, command)), exit_code, "", reason)
    return None


def note_of(point: Point, scene: SceneFile) -> str:
    """The name under which the verdict on a variant, a tolerance and a scene is kept."""
    content = f"{point.program.sha256} {point.variant} {point.tolerance} {scene.sha256}"
    return f"checks/{digest(content)}.json"
