"""What the machine can do at most, measured once before anything is compared with it."""

from dataclasses import asdict

from experiments.plan.point import Point, Tags
from experiments.run.kept_records import KeptRecords, key
from experiments.support.process import Completed

KIND = "limits"
"""The kind of question that compares with them."""

FOLDER = "limits-of-machines"
"""Below `records/`, beside the folders of the experiments."""


def measure_limits(point: Point, records: KeptRecords) -> Completed | None:
    """Run `carom limits`, once for each program, machine, number of threads and binding.

    None if its record is there or the point's kind needs none.
    """
    if point.kind != KIND:
        return None
    name = f"{FOLDER}/{key(point.program.sha256, asdict(point.machine), point.threads, point.openmp)}.json"
    tags: Tags = {"experiment": FOLDER, "site": point.site}
    done = records.ensure("limits", name, point, ["--threads", str(point.threads)], tags)
    if done is None or done.exit_code == 0:
        return done
    return Completed(done.command, done.exit_code, "", f"limits of the machine: {done.reason}")
