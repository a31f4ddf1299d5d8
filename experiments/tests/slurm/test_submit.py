"""Submission to clusters with limits, and to ones that refuse: nothing is half-written, and one line says
why.
"""

import json
from pathlib import Path

import pytest

from experiments.plan.cluster import Partition
from experiments.slurm.jobs import Unit
from experiments.slurm.submit import within_time
from experiments.slurm.task import work
from experiments.tests.conftest import Workplace, finish
from experiments.tests.slurm.fake_slurm import FakeSlurm
from experiments.tests.slurm.fake_slurm_commands import POLICY
from experiments.tests.slurm.test_script import site

BLOCKS = 7
"""Of the three questions of a workplace; 16 processes."""
SECOND = '\n[[slurm.partitions]]\nname = "w5"\ncpus = 2\n'


def say(workplace: Workplace, verb: str, *words: str, code: int = 0) -> tuple[str, str]:
    """Run a verb for the site of the workplace; what it prints."""
    found, output, error = finish(workplace.start(verb, "--site", "cluster.toml", *words))
    assert found == code, output + error
    return output, error


def tasks(workplace: Workplace, partition: str = "xs") -> list[list[Unit]]:
    """The blocks of each task of the last job."""
    paths = sorted(workplace.results.glob(f"slurm/cluster/{partition}/jobs/*.json"))
    return [[(name, block) for name, block in task] for task in json.loads(paths[-1].read_text())["tasks"]]


def took(workplace: Workplace, seconds: float) -> None:
    """Let each process that was measured have taken so long."""
    for path in workplace.results.glob("slurm/cluster/xs/records/*/*/*.json"):
        record = json.loads(path.read_text())
        own = [one | {"process_seconds": seconds} for one in record["contenders"]]
        path.write_text(json.dumps(record | {"contenders": own}))


@pytest.mark.parametrize("place", ["common", "own"])
def test_a_limit_that_the_site_names_is_kept_with_fewer_larger_tasks(
    workplace: Workplace, place: str
) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root, f"# {place}", "max_submitted = 3")
    output, _ = say(workplace, "submit")
    assert "16 processes in 3 tasks" in output
    assert slurm.asked() == [3], "the cluster is not asked for more"
    assert sum(map(len, tasks(workplace))) == BLOCKS


def test_without_room_nothing_is_submitted_and_resume_does_it(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root, "# common", "max_submitted = 2" + SECOND)
    output, _ = say(workplace, "submit")
    assert slurm.arrays() == [1, 1], "both kinds of node have their share"
    slurm.ends("CANCELLED")
    slurm.configure(squeue_lines=["someone|N/A|x", "xs", "xs"])
    output, _ = say(workplace, "resume")
    assert output.splitlines() == [
        f"{name}: max_submitted leaves room for no task; `carom study resume` submits the {BLOCKS} blocks "
        "that are left once jobs of yours have ended"
        for name in ("w5", "xs")
    ]
    assert slurm.arrays() == [1, 1]


@pytest.mark.parametrize(("most", "asked"), [(3, [7, 3]), (1, [7, 3, 1])])
def test_a_limit_that_nobody_named_is_found_by_asking_for_less(
    workplace: Workplace, most: int, asked: list[int]
) -> None:
    slurm = FakeSlurm(workplace, max_submit=most)
    site(workplace.root)
    output, _ = say(workplace, "submit")
    assert f"16 processes in {most} tasks" in output
    assert slurm.asked() == asked
    assert len(tasks(workplace)) == most
    assert len(list(workplace.results.rglob("jobs/*"))) == 2, "one job, and nothing of those refused"


def test_what_is_known_not_to_fit_is_left_to_resume(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root, "# own", "minutes = 2\nmax_submitted = 2")
    say(workplace, "submit", "--blocks", "4")
    work(next(workplace.results.rglob("jobs/*.json")), 0)
    slurm.ends("CANCELLED")
    took(workplace, 15.0)
    output, _ = say(workplace, "resume")
    assert [len(task) for task in tasks(workplace)] == [2, 2], "a signal comes after 90 s"
    assert output.splitlines()[1] == (
        "xs: no more fit into the time limit of so many tasks; "
        "`carom study resume` submits the 2 blocks that are left"
    )


def test_as_many_blocks_as_the_site_wishes_stay_together_however_long_they_take() -> None:
    partition = Partition("xs", 2, 2, minutes=1, blocks_per_task=2)
    units = [("a", number) for number in range(4)]
    assert within_time([units], partition, {"a": 1000.0}) == [units[:2]]
    assert within_time([units], partition, {"a": 15.0}) == [units[:3]]
    assert within_time([units], partition, {}) == [units]


AWAY = ["Batch job submission failed: Unable to contact slurm controller (connect failure)"]
LOST = ["Batch job submission failed: Socket timed out on send/recv operation"]
REFUSALS = {
    "full": (
        [
            "Slurm temporarily unable to accept job, sleeping and retrying",
            "Batch job submission failed: Resource temporarily unavailable",
        ],
        "Resource temporarily unavailable",
    ),
    "another limit": (["QOSMaxWallDurationPerJobLimit", POLICY], "(QOSMaxWallDurationPerJobLimit)"),
}


@pytest.mark.parametrize(("lines", "said"), REFUSALS.values(), ids=REFUSALS.keys())
def test_a_refusal_is_one_line_and_leaves_nothing(workplace: Workplace, lines: list[str], said: str) -> None:
    slurm = FakeSlurm(workplace, refuse={"xs": lines})
    site(workplace.root)
    _, error = say(workplace, "submit", code=1)
    assert error.startswith("carom: sbatch: error: ")
    assert error.endswith(f"{said}; `carom study resume` submits the rest later\n")
    assert error.count("\n") == 1
    assert slurm.asked() == [BLOCKS], "asked once: fewer tasks would not help"
    assert not list(workplace.results.rglob("jobs/*"))
    slurm.configure(refuse={})
    assert "16 processes in 7 tasks" in say(workplace, "submit")[0]


def test_a_user_without_any_room_gets_one_line(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace, max_submit=0)
    site(workplace.root)
    _, error = say(workplace, "submit", code=1)
    assert error == (
        f"carom: sbatch: error: {POLICY} (AssocMaxSubmitJobLimit); "
        "`carom study resume` submits the rest later\n"
    )
    assert slurm.asked() == [7, 3, 1]
    assert not list(workplace.results.rglob("jobs/*"))


@pytest.mark.parametrize("refused", ["xs", "w5"])
def test_what_other_partitions_could_submit_stays(workplace: Workplace, refused: str) -> None:
    slurm = FakeSlurm(workplace, refuse={refused: ["Batch job submission failed: Invalid account"]})
    site(workplace.root, "# common", SECOND)
    output, error = say(workplace, "submit", code=1)
    assert error.startswith("carom: sbatch: error: Batch job submission failed: Invalid account; ")
    (taken,) = {"xs", "w5"} - {refused}
    assert f"{taken}: job 101, 16 processes in 7 tasks" in output
    assert slurm.arrays(taken) == [7]
    slurm.configure(refuse={})
    output, _ = say(workplace, "resume")
    assert f"{taken}: nothing to submit; the rest waits or runs" in output
    assert f"{refused}: job 102, 16 processes in 7 tasks" in output


def test_each_refusal_has_a_line(workplace: Workplace) -> None:
    FakeSlurm(workplace, refuse={"xs": ["Invalid qos"], "w5": ["Invalid account"]})
    site(workplace.root, "# common", SECOND)
    _, error = say(workplace, "submit", code=1)
    assert [line.partition(";")[0] for line in error.splitlines()] == [
        "sbatch: error: Invalid account",
        "carom: sbatch: error: Invalid qos",
    ]


def test_nobody_is_asked_twice_while_the_controller_is_away(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace, refuse={"xs": AWAY, "w5": AWAY}, goes_away={"squeue_fails": AWAY})
    site(workplace.root, "# common", SECOND)
    say(workplace, "submit", code=1)
    assert len(slurm.asked()) == 1


def test_a_job_that_was_taken_although_the_reply_was_lost_is_not_submitted_twice(
    workplace: Workplace,
) -> None:
    slurm = FakeSlurm(workplace, loses_replies=LOST)
    site(workplace.root)
    output, _ = say(workplace, "submit")
    assert "xs: job known by its name, 16 processes in 7 tasks" in output
    assert say(workplace, "resume")[0] == "xs: nothing to submit; the rest waits or runs\n"
    assert slurm.arrays() == [7]


def test_a_list_of_blocks_stays_while_nobody_says_whether_its_job_was_taken(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace, loses_replies=LOST, goes_away={"squeue_fails": LOST})
    site(workplace.root)
    assert "timed out" in say(workplace, "submit", code=1)[1]
    assert len(jobs_of(workplace)) == 1
    slurm.configure(loses_replies=[], goes_away={}, squeue_fails=None)
    assert "nothing to submit; the rest waits or runs" in say(workplace, "resume")[0]
    slurm.ends("CANCELLED")
    assert "16 processes in 7 tasks" in say(workplace, "resume")[0]


def test_arrays_stay_below_what_the_cluster_keeps_at_all(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace, max_job_count=4)
    site(workplace.root)
    say(workplace, "submit")
    assert slurm.asked() == [4]


def test_the_last_submission_is_found_without_any_clock(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root, "# common", SECOND)
    for refused, scale in (("w5", "paper"), ("w5", "paper"), ("xs", "quick")):
        slurm.configure(refuse={refused: ["Invalid account"]})
        say(workplace, "submit", "--scale", scale, code=1)
        slurm.ends("CANCELLED")
    slurm.configure(refuse={})
    say(workplace, "resume")
    jobs = sorted(jobs_of(workplace), key=lambda path: path.name)
    assert [path.stem for path in jobs] == ["0001", "0002", "0003", "0004", "0005"]
    scales = [json.loads(path.read_text())["scale"] for path in jobs]
    assert scales == ["paper"] * 2 + ["quick"] * 3


def jobs_of(workplace: Workplace) -> list[Path]:
    return list(workplace.results.rglob("jobs/*.json"))
