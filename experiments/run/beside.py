"""What some kinds of questions want beside their points: each record made once, and kept under a key of all
that decides it.
"""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass

from experiments.plan.point import Point, Tags
from experiments.plan.program import NOT_BUILT_IN, tag_arguments
from experiments.plan.scenes import SceneFile
from experiments.results.store import Store
from experiments.run.host_lock import run_alone
from experiments.run.progress import warn
from experiments.support.digest import digest
from experiments.support.process import Completed
from support.files import move, read_json
from support.record_schema import is_record


@dataclass(frozen=True)
class Beside:
    """A verb of the program with these `words`, and the `folder` below `records/` where its records go.

    Program, machine and what `decides` says make a record's name, and the number of the block where there is
    one `each_block`. Without the record no point is measured, unless it is `optional`. The verb may take the
    time of so many `processes`, where it does the work of as many.
    """

    verb: str
    folder: str
    called: str
    words: Callable[[Point, SceneFile], tuple[str, ...]]
    decides: Callable[[Point, SceneFile], tuple[object, ...]]
    tags: Callable[[Point, Tags], Tags] = lambda _, tags: tags
    each_block: bool = False
    optional: bool = False
    processes: int = 1


BESIDE = {
    "limits": Beside(
        "limits",
        "limits-of-machines",
        "limits of the machine",
        words=lambda point, _: ("--threads", str(point.threads)),
        decides=lambda point, _: (point.threads, point.openmp),
        tags=lambda point, _: {"experiment": "limits-of-machines", "site": point.site},
    ),
    "promises": Beside(
        "promises",
        "promises-of-errors",
        "promises",
        words=lambda point, scene: (str(scene.path), "--threads", str(point.threads)),
        decides=lambda point, scene: (point.threads, point.openmp, scene.sha256, point.scene_name),
        processes=12,  # a choice and its rivals for each of twelve bounds
    ),
    "speed_against_error": Beside(
        "outside",
        "outside-engines",
        "outside engine",
        words=lambda point, scene: (str(scene.path), "--substeps", str(point.substeps)),
        decides=lambda point, scene: (scene.sha256, point.scene_name, point.substeps),
        tags=lambda _, tags: {**tags, "series": "outside"},
        each_block=True,
        optional=True,
    ),
}
"""By the kind of question: what the machine can do at most; what becomes of promised errors; a general
engine, which is part of some builds only.
"""


class BesideRecords:
    """Runs these verbs, with the point's program and OpenMP variables, where there is no record yet."""

    def __init__(self, store: Store, time_limit: float) -> None:
        self._store = store
        self._time_limit = time_limit
        self._without: set[str | None] = set()

    def ensure(self, point: Point, block: int, scene: SceneFile, tags: Tags) -> Completed | None:
        """Make the record that the point's kind wants, unless it is there. Returns how the verb failed where
        the point cannot be measured without it, else None.
        """
        wanted, program = BESIDE.get(point.kind), point.program.sha256
        if wanted is None or (wanted.optional and program in self._without):
            return None
        key = digest(json.dumps((program, asdict(point.machine), *wanted.decides(point, scene))))
        name = f"{key}-b{block}.json" if wanted.each_block else f"{key}.json"
        path = self._store.root / "records" / wanted.folder / name
        if self._store.holds(path, wanted.verb):
            return None
        scratch = self._store.temporary / f"{wanted.verb}.json"
        scratch.unlink(missing_ok=True)
        words = (wanted.verb, *wanted.words(point, scene), "--record", str(scratch))
        command = [str(point.program.path), *words, *tag_arguments(wanted.tags(point, tags))]
        done = run_alone(command, point.openmp, self._time_limit * wanted.processes)
        if done.exit_code == 0 and is_record(read_json(scratch)):
            move(scratch, path)
            return None
        reason = done.reason if done.exit_code else "no record that can be used"
        if not wanted.optional:
            return Completed(done.command, done.exit_code or 1, "", f"{wanted.called}: {reason}")
        if done.exit_code == NOT_BUILT_IN:
            self._without.add(program)
        else:
            warn(f"{wanted.called}: not measured: {reason}")
        return None
