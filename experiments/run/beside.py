"""Records made beside those of the points: whole and kept under a name of their content, or not there."""

import hashlib
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from experiments.run.turn import run_in_turn
from experiments.support.files import move, read_json
from experiments.support.process import Completed
from experiments.support.schema import is_record


def record(
    command: Sequence[str], openmp: Iterable[tuple[str, str]], time_limit: float, scratch: Path, path: Path
) -> Completed:
    """Run a command that writes a record to `scratch`; keep it at `path` if it can be used."""
    scratch.unlink(missing_ok=True)
    done = run_in_turn(command, openmp, time_limit)
    if done.exit_code != 0:
        return done
    if not is_record(read_json(scratch)):
        return Completed(done.command, 1, "", "no record that can be used")
    move(scratch, path)
    return done


def name_of(content: Sequence[object]) -> str:
    """16 hexadecimal digits over what decides a measurement."""
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()[:16]
