"""What becomes of the promises of `carom run --error-below`, seen once on each scene of their question."""

from dataclasses import asdict

from experiments.plan.point import Point, Tags
from experiments.plan.scenes import SceneFile
from experiments.run.kept_records import KeptRecords, key
from experiments.support.process import Completed

KIND = "promises"
"""The kind of question that is about them."""

FOLDER = "promises-of-errors"
"""Below `records/`, beside the folders of the experiments."""


def keep_promises(point: Point, scene: SceneFile, tags: Tags, records: KeptRecords) -> Completed | None:
    """Run `carom promises`, once for each program, machine, number of threads, binding and scene.

    None if its record is there or the point's kind needs none.
    """
    if point.kind != KIND:
        return None
    made_of = key(
        point.program.sha256, asdict(point.machine), point.threads, point.openmp, scene.sha256,
        point.scene_name,
    )  # fmt: skip
    words = [str(scene.path), "--threads", str(point.threads)]
    done = records.ensure("promises", f"{FOLDER}/{made_of}.json", point, words, tags)
    if done is None or done.exit_code == 0:
        return done
    return Completed(done.command, done.exit_code, "", f"promises: {done.reason}")
