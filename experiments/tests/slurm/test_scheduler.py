"""What Slurm's commands answer, from version 21 to 25."""

import pytest

from experiments.slurm import scheduler
from experiments.slurm.scheduler import TaskState
from experiments.tests.conftest import Workplace
from experiments.tests.slurm.fake_slurm import FakeSlurm

CONFIGURATIONS = {
    "23.11": (
        "Configuration data as of 2024-03-01T10:00:00\n"
        "CliFilterPlugins        = (null)\n"
        "MaxArraySize            = 75000\n"
        "MaxBatchRequeue         = 5\n"
        "MaxJobCount             = 20000\n"
        "\nCgroup Support Configuration:\nConstrainCores          = yes\nMaxRAMPercent           = 100.0%\n",
        20000,
    ),
    "25.05": (
        "Configuration data as of 2025-06-01T10:00:00\r\n"
        "HashPlugin              = hash/sha3\r\n"
        "MaxArraySize            = 40001\r\n"
        "MaxJobCount             = 500000\r\n",
        40001,
    ),
    "no arrays": ("MaxArraySize = 0\nMaxJobCount = 10000\n", 1),
}


@pytest.mark.parametrize(("said", "size"), CONFIGURATIONS.values(), ids=CONFIGURATIONS.keys())
def test_the_largest_array_is_read_of_every_version(workplace: Workplace, said: str, size: int) -> None:
    FakeSlurm(workplace, show_config=said)
    assert scheduler.max_array_size() == size


STATES = {
    "runs": ("RUNNING", "SUSPENDED", "STOPPED", "COMPLETING", "CONFIGURING", "POWER_UP_NODE", "STAGE_OUT"),
    "waits": ("PENDING", "REQUEUED", "REQUEUE_HOLD", "SPECIAL_EXIT", "EXPEDITING", "RESV_DEL_HOLD"),
    "ended": (
        *("COMPLETED", "CANCELLED", "FAILED", "TIMEOUT", "NODE_FAIL", "PREEMPTED", "BOOT_FAIL", "DEADLINE"),
        *("OUT_OF_MEMORY", "REVOKED", "RECONFIG_FAIL", "CANCELLED+", "A_STATE_OF_TOMORROW"),
    ),
}


@pytest.mark.parametrize(
    ("what", "state"), [(what, state) for what, states in STATES.items() for state in states]
)
def test_each_state_means_one_of_three_things(what: str, state: str) -> None:
    found = TaskState(state, "None")
    assert (found.waits, found.runs) == (what == "waits", what == "runs")


def test_lines_of_every_kind_are_read_and_others_left(workplace: Workplace) -> None:
    FakeSlurm(
        workplace,
        squeue_lines=[
            "0|RUNNING|None|carom-xs-1",
            "2|PENDING|Nodes required for job are DOWN, DRAINED or reserved|carom-xs-1",
            "N/A|RUNNING|None|somebody's | job |7",
            "|RUNNING",
            "",
            "7|COMPLETING|None|carom-xs-1",
            "7|REVOKED|None|carom-xs-1",
            "8|OUT_OF_ME+|OutOfMemory|carom-xs-1",
        ],
    )
    found = scheduler.queue()
    assert sorted(found) == [("carom-xs-1", index) for index in (0, 2, 7, 8)]
    assert found["carom-xs-1", 2].reason == "Nodes required for job are DOWN, DRAINED or reserved"
    assert found["carom-xs-1", 7].runs, "of a task that is listed twice the living one counts"


def test_jobs_are_counted_as_the_limits_count_them(workplace: Workplace) -> None:
    FakeSlurm(workplace, squeue_lines=["xs", "xs", "w5", ""])
    assert scheduler.in_queue() == {"xs": 2, "w5": 1}
