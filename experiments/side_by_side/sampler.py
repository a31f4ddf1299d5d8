"""`carom processes`: lets programs run in slices of time, and tells the facts of each run."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from experiments.plan.site import clean_environment
from experiments.side_by_side.run_result import RunResult
from experiments.support.descendants import children, end_all_but
from experiments.support.process import Coprocess

_MARGIN_SECONDS = 60.0
"""What measuring takes beside the processes, before it is given up."""

_STOPS = 2.0
"""How much longer all of them take at most, with the time until each stands still."""


class SamplerError(Exception):
    """Why nothing can be measured, in one line."""


@dataclass(frozen=True)
class ProcessCommand:
    """A program to be run as it is: no shell sees its words."""

    command: Sequence[str]
    folder: str = ""
    """That it runs in; empty: this process's own."""
    environment: Mapping[str, str] = field(default_factory=dict)
    """Beside that of this process."""
    most_seconds: float = 600.0
    """Of its own running time; what takes longer is ended."""
    most_seconds_behind: float = 1e9
    """That what it started may go on after its own end."""
    output_file: str = ""
    """That its standard output goes into as well."""
    expected_seconds: float = 0.0
    """How long it takes undisturbed, or 0 where nobody knows."""


class Sampler:
    """A context manager; what it has started ends with it, however that ends."""

    def __init__(self, program: Path) -> None:
        self._child = Coprocess((str(program), "processes"), clean_environment({}))

    def __enter__(self) -> "Sampler":
        self._known = children()
        return self

    def __exit__(self, *_: object) -> None:
        self._child.__exit__()
        end_all_but(self._known)

    def run(
        self, commands: Sequence[ProcessCommand], slice_seconds: float = 1.0, seed: int = 0
    ) -> list[RunResult]:
        """Run them in turn, each for so many seconds at a time, and one without a pause. Raises SamplerError
        where there is no room for them.
        """
        plan = {"processes": [*map(asdict, commands)], "slice_seconds": slice_seconds, "seed": seed}
        limit = _STOPS * sum(one.most_seconds for one in commands)
        return [RunResult(**one) for one in self._ask(plan, limit)]

    def surroundings(self, threads: int, scene: Path | None) -> tuple[dict[str, Any], Any]:
        """The provenance of what runs on so many threads, and what a record says of the scene."""
        told = self._ask({"threads": threads, "scene": None if scene is None else str(scene)}, 0.0)
        return told["provenance"], told["scene"]

    def _ask(self, question: Mapping[str, Any], seconds: float) -> Any:  # noqa: ANN401 - JSON is any value
        done = self._child.ask(json.dumps(question), seconds + _MARGIN_SECONDS)
        if done.exit_code != 0:
            raise SamplerError(done.reason.removeprefix("carom: "))
        try:
            return json.loads(done.output)
        except ValueError as error:
            raise SamplerError("what measures it was ended by somebody") from error
