"""The batch script of one job array, from the template `job.sh.jinja`."""

import shlex
import sys
from collections.abc import Mapping
from pathlib import Path

import jinja2

from experiments.plan.cluster import Partition
from support.errors import InputError
from support.home import ROOT

COMPILERS = {"gcc": "g++", "clang": "clang++"}


_OF_MEMORY = ("--mem", "--mem-per-cpu", "--mem-per-gpu")


def render(job: str, partition: Partition, manifest: Path, tasks: int, programs: Mapping[str, str]) -> str:
    """The script of an array of `tasks` tasks that work through `manifest`.

    The template quotes every value that is put into it, so that no shell takes one for anything but a word.
    Raises InputError for a program that is to be built in the job but that this project does not know how to
    build, and for an option that would not stay within its line.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        undefined=jinja2.StrictUndefined,
        finalize=lambda value: shlex.quote(str(value)),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    folder = manifest.parent.parent
    return environment.get_template("job.sh.jinja").render(
        partition=partition,
        options=[_one_line(option) for option in _options(job, partition, manifest, tasks)],
        builds=_builds(folder / "build", programs) if partition.build else [],
        folder=folder,
        root=ROOT,
        python=sys.executable,
        manifest=manifest,
    )


def _options(job: str, partition: Partition, manifest: Path, tasks: int) -> list[str]:
    optional = {"account": partition.account, "qos": partition.qos, "constraint": partition.constraint}
    # In a file name Slurm puts %a and the like in place; a % of the folder's own is written twice.
    log = str(manifest.with_suffix("")).replace("%", "%%") + "-%a.log"
    return [
        f"--job-name={job}",
        f"--partition={partition.name}",
        *(f"--{key}={value}" for key, value in optional.items() if value is not None),
        "--nodes=1",
        "--ntasks=1",
        f"--cpus-per-task={partition.cpus}",
        "--exclusive",
        *_memory(partition),
        "--hint=nomultithread",
        f"--time={partition.minutes}",
        f"--signal=USR1@{partition.signal_seconds}",
        f"--array=0-{tasks - 1}%{partition.at_once}",
        "--requeue",
        f"--chdir={ROOT}",
        f"--output={log}",
        "--open-mode=append",
        *partition.arguments,
    ]


def _memory(partition: Partition) -> list[str]:
    """All of the node's: even with a whole node comes no more than DefMemPerCPU for each processor."""
    return [] if any(one.split("=")[0] in _OF_MEMORY for one in partition.arguments) else ["--mem=0"]


def _one_line(option: str) -> str:
    """The option, which stands in a comment that Slurm reads: at the line's end bash would go on reading."""
    if not option.isprintable() or any(sign in option for sign in "'\"\\#"):
        raise InputError(
            f"{option!r}: cannot be said in a batch script; expected no quotes, backslashes, # and line ends"
        )
    return option


def _builds(folder: Path, programs: Mapping[str, str]) -> list[tuple[str, Path]]:
    """C++ compiler and build folder of each program."""
    for name, relative in programs.items():
        if name not in COMPILERS or relative != f"{name}/carom":
            known = ", ".join(f'{one} = "{one}/carom"' for one in COMPILERS)
            raise InputError(f'programs.{name}: found "{relative}"; a job can build {known}, and no others')
    return [(COMPILERS[name], folder / name) for name in programs]
