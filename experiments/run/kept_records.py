"""Records beside those of the points: each made once, and kept under a key of all that decides it."""

import json
from collections.abc import Sequence

from experiments.plan.point import Point, Tags
from experiments.plan.program import tag_arguments
from experiments.results.store import Store
from experiments.run.host_lock import run_alone
from experiments.support.digest import digest
from experiments.support.process import Completed
from support.files import move, read_json
from support.record_schema import is_record


class KeptRecords:
    """Runs verbs of the program that write a record, where there is none yet."""

    def __init__(self, store: Store, time_limit: float) -> None:
        self._store = store
        self._time_limit = time_limit

    def ensure(
        self, verb: str, name: str, point: Point, words: Sequence[str], tags: Tags
    ) -> Completed | None:
        """Make the record `name` below `records/`, unless one of that verb is there: then None.

        The verb is run with the point's program and OpenMP variables.
        """
        path = self._store.root / "records" / name
        if self._store.holds(path, verb):
            return None
        scratch = self._store.temporary / f"{verb}.json"
        scratch.unlink(missing_ok=True)
        command = [str(point.program.path), verb, *words, "--record", str(scratch), *tag_arguments(tags)]
        done = run_alone(command, point.openmp, self._time_limit)
        if done.exit_code != 0:
            return done
        if not is_record(read_json(scratch)):
            return Completed(done.command, 1, "", "no record that can be used")
        move(scratch, path)
        return done


def key(*content: object) -> str:
    """16 hexadecimal digits over what decides a measurement."""
    return digest(json.dumps(content))
