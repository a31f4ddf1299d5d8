"""A general engine beside the variants: measured where a program was built with it, else left out."""

import hashlib
import json
from dataclasses import asdict

from experiments.plan.point import Point, Tags
from experiments.plan.program import tag_arguments
from experiments.plan.scenes import SceneFile
from experiments.results.store import Store
from experiments.run.turn import run_in_turn
from experiments.support.files import move, read_json
from experiments.support.process import Completed
from experiments.support.schema import is_record

FIGURE = "speed_against_error"
"""The kind of figure that it stands in."""

FOLDER = "outside-engines"
"""Below `records/`, beside the folders of the experiments."""

ABSENT = "built without"


class Outside:
    """Runs `carom outside` once a block for each scene and number of substeps; records are kept."""

    def __init__(self, store: Store, time_limit: float) -> None:
        self._store = store
        self._time_limit = time_limit
        self._without: set[str | None] = set()

    def measure(self, point: Point, block: int, scene: SceneFile, tags: Tags) -> Completed | None:
        """Measure the engine on the point's scene, with its substeps, in this block.

        None if its record is there, the figure needs none, or the program was built without it. That it went
        wrong is no failure of the point.
        """
        if point.figure != FIGURE or point.program.sha256 in self._without:
            return None
        path = self._store.root / "records" / FOLDER / f"{_name(point, scene)}-b{block}.json"
        if self._store.holds(path, "outside"):
            return None
        scratch = self._store.temporary / "outside.json"
        scratch.unlink(missing_ok=True)
        words = [str(point.program.path), "outside", str(scene.path), "--substeps", str(point.substeps)]
        words += ["--record", str(scratch), *tag_arguments({**tags, "series": "outside"})]
        done = run_in_turn(words, point.openmp, self._time_limit)
        if ABSENT in done.error:
            self._without.add(point.program.sha256)
            return None
        if done.exit_code == 0 and not is_record(read_json(scratch)):
            return Completed(done.command, 1, "", "no record that can be used")
        if done.exit_code == 0:
            move(scratch, path)
        return done


def _name(point: Point, scene: SceneFile) -> str:
    content = [point.program.sha256, asdict(point.machine), scene.sha256, point.scene_name, point.substeps]
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()[:16]
