"""A general engine beside the variants: measured where a program was built with it, else left out."""

from dataclasses import asdict

from experiments.plan.point import Point, Tags
from experiments.plan.program import NOT_BUILT_IN
from experiments.plan.scenes import SceneFile
from experiments.run.kept_records import KeptRecords, key
from experiments.support.process import Completed

KIND = "speed_against_error"
"""The kind of question that it stands beside."""

FOLDER = "outside-engines"
"""Below `records/`, beside the folders of the experiments."""


class Outside:
    """Runs `carom outside` once a block for each scene and number of substeps; records are kept."""

    def __init__(self, records: KeptRecords) -> None:
        self._records = records
        self._without: set[str | None] = set()

    def measure(self, point: Point, block: int, scene: SceneFile, tags: Tags) -> Completed | None:
        """Measure the engine on the point's scene, with its substeps, in this block.

        None if its record is there, the kind needs none, or the program was built without it. That it went
        wrong is no failure of the point.
        """
        program = point.program.sha256
        if point.kind != KIND or program in self._without:
            return None
        made_of = key(program, asdict(point.machine), scene.sha256, point.scene_name, point.substeps)
        words = [str(scene.path), "--substeps", str(point.substeps)]
        name = f"{FOLDER}/{made_of}-b{block}.json"
        done = self._records.ensure("outside", name, point, words, {**tags, "series": "outside"})
        if done is not None and done.exit_code == NOT_BUILT_IN:
            self._without.add(program)
            return None
        return done
