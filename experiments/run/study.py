"""The study as the command line asks for it: its questions planned, its results folder, its schedule."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.plan import question, site
from experiments.plan.claims import CLAIMS
from experiments.plan.plan import SEED, Experiment, Surroundings, plan
from experiments.plan.program import GENERATOR, Program, find_programs
from experiments.plan.question import load_questions, with_blocks
from experiments.plan.scale import find_scale
from experiments.plan.scenes import SceneFolder
from experiments.plan.site import Machine
from experiments.results.store import Store, measured_by_point, new_session
from experiments.run.costs import Costs
from experiments.run.progress import about
from experiments.run.runner import Runner
from experiments.run.schedule import Part, Schedule
from support.errors import InputError
from support.files import write_text
from support.home import BUILDS, ROOT

FINISHED = "finished.json"
BEGUN = "begun.json"
REPORT_FAILED = 1
POINTS_FAILED = 2


@dataclass(frozen=True)
class Settings:
    """What the command line says."""

    study: tuple[str, ...] = ()
    scale: str = "paper"
    site: str = "local"
    results: Path = Path("results")
    build: Path = BUILDS
    builds: tuple[str, ...] = ()
    questions: Path = question.FOLDER
    blocks: int | None = None
    budget_seconds: float | None = None
    until_decided: bool = False
    seed: int = SEED
    figures: bool = True


class Study:
    """The questions chosen, planned for a machine, and the folder that holds their results."""

    def __init__(self, settings: Settings, machine: Machine | None = None) -> None:
        """Plan for this machine, or for another one that is named."""
        self.settings = settings
        self.site = site.load_site(settings.site)
        self.scale = find_scale(settings.scale)
        self.budget_seconds = settings.budget_seconds or self.scale.budget_seconds
        if self.site.cluster is not None and machine is None:
            raise InputError(
                f"site {self.site.name}: is a cluster; use `carom study submit --site {settings.site}`"
            )
        programs = find_programs(self.site, settings.build)
        self.generator: Program = programs[GENERATOR]
        if self.generator.sha256 is None:
            raise InputError(self.generator.remedy)
        self.store = Store(settings.results, new_session())
        machine = machine or site.this_machine()
        around = Surroundings(self.site, machine, programs, self.scale, settings.seed)
        all_questions, builds = load_questions(settings.questions, settings.study), {*settings.builds}
        questions = [one for one in all_questions if not builds or one.programs <= builds]
        report_seconds = self.scale.report_seconds if settings.figures else 0.0
        self.is_whole = len(questions) == len(all_questions)
        self.measuring_seconds = (self.budget_seconds - report_seconds) * len(questions) / len(all_questions)
        self.experiments: tuple[Experiment, ...] = tuple(
            plan(with_blocks(self.scale.question(one), settings.blocks), around) for one in questions
        )

    def runner(self, scenes: Path | None = None, **more: Any) -> Runner:  # noqa: ANN401 - as a runner has it
        """What runs one task; the results folder must be held. The scenes are in it, or in a folder of their
        own.
        """
        folder = scenes or self.store.root / "scenes"
        made = SceneFolder(folder, self.store.temporary, str(self.generator.sha256))
        return Runner(self.store, made, self.generator, self.site.time_limit_seconds, **more)

    def schedule(self, *, settle: bool) -> Schedule:
        """What is there and what is to be run; `settle` moves stale records out of the way first."""
        look = self.store.settle if settle else self.store.find
        found = {one.name: look(one) for one in self.experiments}
        costs = Costs(measured_by_point(found.values()))
        return Schedule([Part(one, self.store, found[one.name], costs) for one in self.experiments], costs)

    @property
    def is_finished(self) -> bool:
        """Whether a session came to the end of these experiments: a further one has nothing to decide."""
        return self._key in (self.store.note(FINISHED) or [])

    def finish(self) -> None:
        """Write down that a session came to the end."""
        if not self.is_finished:
            self.store.keep_note(FINISHED, [*(self.store.note(FINISHED) or []), self._key])

    @property
    def seconds_begun(self) -> float:
        """How long the part of the study took that some of the builds can measure, checks and figures
        included; 0 if there was none.
        """
        begun = self.store.note(BEGUN)
        seconds = begun.get(self._asked) if isinstance(begun, dict) else None
        return float(seconds) if isinstance(seconds, int | float) else 0.0

    def begin(self, seconds: float) -> None:
        """Write down how long that part took."""
        self.store.keep_note(BEGUN, {self._asked: max(seconds, self.seconds_begun)})

    @property
    def _asked(self) -> str:
        return f"{self.scale.name}: {', '.join(self.settings.study)}"

    @property
    def _key(self) -> str:
        return f"{self.scale.name}: {', '.join(sorted(one.name for one in self.experiments))}"


def keep_claims(questions: Path, results: Path) -> None:
    """Let the results say what is claimed of them, where the questions are not the published ones, and where
    the questions are.
    """
    folder = questions.resolve()
    if folder != question.FOLDER:
        claims = questions / CLAIMS
        told = claims.read_text(encoding="utf-8") if claims.exists() else "# Nothing is claimed.\n"
        shown = folder.relative_to(ROOT) if folder.is_relative_to(ROOT) else folder
        # A text of JSON is one of TOML, and a key of the whole file stands before its tables.
        place = json.dumps(str(shown), ensure_ascii=False)
        write_text(results / CLAIMS, f"questions = {place}\n{told}", results)


def summary(schedule: Schedule, budget_seconds: float) -> str:
    """What is about to be run, in one line."""
    status = schedule.status()
    points = sum(len(one.experiment.points) for one in schedule.parts.values())
    text = f"{len(schedule.parts)} experiments, {points} points, {status.planned} processes; "
    if status.done == status.planned:
        return text + "all of them are done"
    text += f"{status.planned - status.done} of them to be run: {about(status.seconds_left)}"
    if status.seconds_left > budget_seconds:
        text += (
            f", although the budget is {about(budget_seconds)}: the least number of blocks takes that long"
            " (less: --study picks questions, --scale quick is the small study)"
        )
    else:
        text += f", then more of what is open, within {about(budget_seconds)}"
    return text
