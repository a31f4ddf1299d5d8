"""What became of the tasks of a job, in words: by the queue, by their logs, and by what they told."""

import re
from pathlib import Path

from experiments.slurm.scheduler import TaskState
from experiments.slurm.task_log import Told

_LAST = 4096
"""Bytes of a log in which its end is looked for."""

_ENDS = (
    (r"DUE TO TIME LIMIT", "ran out of time (`minutes` in the site file)"),
    (r"DUE TO PREEMPTION", "were preempted and not started again"),
    (r"DUE TO NODE FAILURE", "lost their node"),
    (r"oom.?kill|out.of.memory", "had too little memory (`--mem` in `arguments`)"),
    (r"CANCELLED AT", "were cancelled"),
)
"""What slurmstepd writes into a log, and what it means; the first that fits counts."""

_STATES = {
    "TIMEOUT": "ran out of time (`minutes` in the site file)",
    "OUT_OF_MEMORY": "had too little memory (`--mem` in `arguments`)",
    "PREEMPTED": "were preempted and not started again",
    "NODE_FAIL": "lost their node",
    "BOOT_FAIL": "lost their node",
    "DEADLINE": "could not end before their deadline",
}


def fate(state: TaskState | None, log: Path) -> str:
    """What became of a task that left blocks unfinished; `state` is None if Slurm has forgotten it."""
    if state is not None and state.waits:
        return f"wait: {state.reason}"
    if not log.exists():
        return "never started, and have left the queue (cancelled?)"
    ended = f"ended as {state.state}" if state is not None else "have ended"
    why = (_STATES.get(state.state) if state is not None else None) or _end_of(log)
    told = f", since they {why}," if why else ""
    return f"{ended}{told} and left processes unfinished; their logs are in {log.parent}"


def of_all_tasks(told: Told) -> list[str]:
    """What is to be known of all tasks together."""
    lines = []
    if told.restarted:
        lines.append(
            f"{told.restarted} of the tasks were started again by Slurm (preempted, requeued, or their node "
            "died); each went on with what was not begun"
        )
    if len(told.processors) > 1:
        kinds = ", ".join(sorted(told.processors))
        lines.append(
            f"its nodes differ, and count as {len(told.processors)} machines: {kinds}; "
            "`constraint` in the site file picks one"
        )
    return lines


def _end_of(log: Path) -> str:
    """Why a task ended, as far as its log tells; empty if it does not."""
    try:
        with log.open("rb") as file:
            file.seek(max(0, log.stat().st_size - _LAST))
            text = file.read().decode(errors="replace")
    except OSError:
        return ""
    return next((told for end, told in _ENDS if re.search(end, text, re.IGNORECASE)), "")
