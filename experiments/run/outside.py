"""A general engine beside the variants: measured where a program was built with it, else left out."""

from dataclasses import asdict

from experiments.plan.point import Point, Tags
from experiments.plan.program import NOT_BUILT_IN, tag_arguments
from experiments.plan.scenes import SceneFile
from experiments.results.store import Store
from experiments.run import beside
from experiments.support.process import Completed

FIGURE = "speed_against_error"
"""The kind of figure that it stands in."""

FOLDER = "outside-engines"
"""Below `records/`, beside the folders of the experiments."""


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
        words = [str(point.program.path), "outside", str(scene.path), "--substeps", str(point.substeps)]
        words += ["--record", str(scratch), *tag_arguments({**tags, "series": "outside"})]
        done = beside.record(words, point.openmp, self._time_limit, scratch, path)
        if done.exit_code == NOT_BUILT_IN:
            self._without.add(point.program.sha256)
            return None
        return done


def _name(point: Point, scene: SceneFile) -> str:
    content = [point.program.sha256, asdict(point.machine), scene.sha256, point.scene_name, point.substeps]
    return beside.name_of(content)
