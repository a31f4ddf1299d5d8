"""What the feigned commands do; each is a copy of this file, and its own name says which.

FAKE_SLURM is the file of the cluster's state. Its `config` may say: `max_array_size`, `max_job_count`,
`max_submit` (jobs of the user), `refuse` (by partition, what sbatch says), `loses_replies` (a job is taken,
and sbatch told otherwise), `goes_away` (how it is configured once sbatch has failed), `squeue_fails` (what
squeue says), `squeue_lines` (all that it prints),
`show_config` (all that scontrol prints).
"""

import json
import os
import re
import sys
from pathlib import Path
from typing import Any

LIVE = ("PENDING", "RUNNING", "SUSPENDED", "COMPLETING")
POLICY = "Batch job submission failed: Job violates accounting/QOS policy "
POLICY += "(job submit limit, user's size and/or time limits)"


def main(words: list[str]) -> int:
    path = Path(os.environ["FAKE_SLURM"])
    state = json.loads(path.read_text(encoding="utf-8"))
    command = {"sbatch": sbatch, "squeue": squeue, "scontrol": scontrol}[Path(sys.argv[0]).name]
    code = command(state, words)
    path.write_text(json.dumps(state), encoding="utf-8")
    return code


def sbatch(state: dict[str, Any], words: list[str]) -> int:
    config, options = state["config"], read_options(Path(words[-1]))
    tasks = 1 + int(options["array"].removeprefix("0-").partition("%")[0])
    state["asked"].append(tasks)
    said = config.get("refuse", {}).get(options["partition"])
    if said is None and tasks > config.get("max_array_size", 1001):
        said = ["Batch job submission failed: Invalid job array specification"]
    queued = sum(task["state"] in LIVE for job in state["jobs"] for task in job["tasks"])
    if said is None and "max_submit" in config and queued + tasks > config["max_submit"]:
        said = ["AssocMaxSubmitJobLimit", POLICY]
    if said is not None:
        config |= config.get("goes_away", {})
        return fail("sbatch", said)
    job = {"name": options["job-name"], "partition": options["partition"]}
    waits = {"state": "PENDING", "reason": "Resources"}
    state["jobs"].append(job | {"tasks": [waits] * tasks})
    if config.get("loses_replies"):
        config |= config.get("goes_away", {})
        return fail("sbatch", config["loses_replies"])
    print(f"{100 + len(state['jobs'])}")
    return 0


def read_options(script: Path) -> dict[str, str]:
    lines = script.read_text(encoding="utf-8").splitlines()
    options = [line.split(maxsplit=1)[1].strip("'") for line in lines if line.startswith("#SBATCH ")]
    return dict(option.removeprefix("--").partition("=")[::2] for option in options)


def squeue(state: dict[str, Any], words: list[str]) -> int:
    config = state["config"]
    if config.get("squeue_fails"):
        return fail("squeue", config["squeue_fails"])
    if "squeue_lines" in config:
        print("\n".join(config["squeue_lines"]))
        return 0
    form = next(word.partition("=")[2] for word in words if word.startswith("--format="))
    for job in state["jobs"]:
        for index, task in enumerate(job["tasks"]):
            if task["state"] in LIVE or "--states=all" in words:
                values = {"%K": index, "%T": task["state"], "%r": task["reason"]}
                values |= {"%P": job["partition"], "%j": job["name"]}
                print("".join(str(values.get(part, part)) for part in re.split("(%[A-Za-z])", form)))
    return 0


def scontrol(state: dict[str, Any], _words: list[str]) -> int:
    config = state["config"]
    sizes = {
        "MaxArraySize": config.get("max_array_size", 1001),
        "MaxJobCount": config.get("max_job_count", 10000),
    }
    print(config.get("show_config") or "\n".join(f"{key:<24}= {value}" for key, value in sizes.items()))
    return 0


def fail(command: str, lines: list[str]) -> int:
    print("\n".join(f"{command}: error: {line}" for line in lines), file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
