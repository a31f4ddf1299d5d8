"""One point of a figure: everything that decides what is measured, and the id made from it."""

import json
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Final

from experiments.plan.command import Command, placed
from experiments.plan.program import Program, tag_arguments
from experiments.plan.scenes import AnyScene, HardCase, NoScene, Scene
from experiments.plan.site import Machine
from experiments.support.digest import digest

Tags = dict[str, str | int | float]

PROCESS: Final = "process"
"""The verb of points of which whole processes are timed."""

SHORT_BENCHMARK = "--benchmark_min_time=0.1"
"""A case of a Google Benchmark is many short processes, which alternate with those that it is compared with.
Written without its unit, which versions before 1.8 do not know.
"""


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """Everything that decides what is measured: every field is part of the id.

    The label is one of them: the control measures the same under two labels. So is the number of the
    `replicate`, where a block measures the same several times.
    """

    label: str | None
    replicate: int
    site: str
    machine: Machine
    verb: str
    program: Program
    scene: AnyScene
    variant: str | None
    command: Command | None
    find_chunk: int | None = None
    resolve_chunk: int | None = None
    threads: int
    substeps: int = 1
    tolerance: str
    warm_up: int
    repetitions: int
    errors: bool
    simulated: int
    openmp: tuple[tuple[str, str], ...]
    apart: bool

    @cached_property
    def id(self) -> str:
        """`p` and 16 hexadecimal digits; equal ids are the same measurement in any figure."""
        content = {field.name: getattr(self, field.name) for field in fields(Measurement)}
        # The letter keeps the id a text: the program takes a tag that reads as a number for one.
        return "p" + digest(json.dumps(content, sort_keys=True, default=_content))

    @property
    def is_checked(self) -> bool:
        """Whether its steps can be verified before it is timed."""
        return self.command is None or bool(self.command.trajectory)

    @property
    def refused(self) -> str:
        """Why it cannot be run at all; empty if it can."""
        return self.command.refused if self.command is not None else ""

    @property
    def axes(self) -> dict[str, str | int | None]:
        """What the program is told to do with the scene."""
        return {
            "variant": self.variant,
            "find_chunk": self.find_chunk,
            "resolve_chunk": self.resolve_chunk,
            "threads": self.threads,
            "substeps": self.substeps,
            "tolerance": self.tolerance,
        }


@dataclass(frozen=True, kw_only=True)
class Point(Measurement):
    """A measurement and what only says where in which figure it is shown."""

    experiment: str
    kind: str
    figure: str
    claim: str | None
    margin: float
    error: float
    reference: str | None
    series: str
    series_number: int
    scene_name: str | None = None
    x_name: str
    x: float
    scale: str

    @cached_property
    def tags(self) -> Tags:
        """What a record of the point tells those who draw it."""
        measured = {field.name for field in fields(Measurement)}
        shown = {
            field.name: getattr(self, field.name) for field in fields(self) if field.name not in measured
        }
        told = {
            "label": self.label,
            "replicate": self.replicate,
            "site": self.site,
            "program": self.program.name,
            "point": self.id,
        }
        return {key: value for key, value in (shown | told).items() if value is not None}

    @property
    def timeline(self) -> str:
        """The name of the file that shows a profiled run of the point, thread by thread."""
        swept = f"-{self.x:g}" if self.x else ""
        on = f"-{self.scene_name}" if self.scene_name else ""
        return re.sub(r"[^\w.+-]", "_", f"{self.experiment}-{self.series}{on}{swept}.json")

    def measures_errors(self, block: int) -> bool:
        """Whether the process of that block measures errors too: every run of a point ends in the same bits,
        so one is enough.
        """
        return self.errors and block == 0

    def besides(self, block: int) -> tuple[str, ...]:
        """The options for what the process of that block does besides: what comes out the same in every one
        is done in the first alone.
        """
        words = ["--errors"] if self.measures_errors(block) else []
        if self.simulated and block == 0:
            words += ["--simulated", "--simulated-steps", str(self.simulated)]
        return tuple(words)

    def bench_words(
        self, scene: Path, tags: Tags, timeline: Path | None = None, besides: Sequence[str] = ()
    ) -> tuple[str, ...]:
        """The command that measures the point once, does what else it is told to, and writes the timeline of
        a profile; all but the place of its record.
        """
        words = self._words(self.verb, scene)
        words += ["--warm-up", str(self.warm_up)]
        if self.verb == "bench":
            words += ["--repetitions", str(self.repetitions)]
        words += besides
        if timeline is not None:
            words += ["--timeline", str(timeline), "--timeline-chunks"]
        return (*words, *tag_arguments(tags))

    def process_words(self, scene: Path | None, output: Path) -> tuple[str, ...]:
        """The command of the process that is timed as a whole: the program's own words, or `carom run`. A
        Google Benchmark writes what it found into `output`, and others their trajectory.
        """
        if self.command is None:
            assert scene is not None
            return tuple(self._words("run", scene))
        words = placed(self.command.words, scene, output)
        if self.command.benchmark is None:
            return words
        short = () if any(one.startswith("--benchmark_min_time") for one in words) else (SHORT_BENCHMARK,)
        return (*words, *short, f"--benchmark_out={output}", "--benchmark_out_format=json")

    def _words(self, verb: str, scene: Path) -> list[str]:
        words = [str(self.program.path), verb, str(scene)]
        words += ["--variant", str(self.variant), "--threads", str(self.threads)]
        words += ["--substeps", str(self.substeps), "--tolerance", self.tolerance, *self.program.variants_of]
        for option, chunk in (("--find-chunk", self.find_chunk), ("--resolve-chunk", self.resolve_chunk)):
            if chunk is not None:
                words += [option, str(chunk)]
        return words


def _content(value: object) -> object:
    """What of a field that is no plain value decides the measurement: of a program not where it is."""
    match value:
        case Program():
            return value.name, value.sha256
        case Scene() | HardCase() | NoScene():
            return value.arguments
        case Command():
            return value.content
        case Machine():
            return asdict(value)
    raise TypeError(f"{value!r} has no place in an id")
