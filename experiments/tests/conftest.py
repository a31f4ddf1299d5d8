"""A workplace in a temporary folder: a fake program, two small questions, a results folder."""

import errno
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from experiments.__main__ import main
from experiments.plan.point import Point
from experiments.plan.scenes import Scene
from experiments.run import session, status
from experiments.run.study import Settings, Study
from experiments.run.verdicts import Open, Verdicts
from experiments.side_by_side.contest import Contender, Contest, Entrant
from experiments.tests.forks import Forking, forked
from support.errors import InputError

ROOT = Path(__file__).parents[2]
FAKE = Path(__file__).with_name("fake_carom.py")


def told_in(name: str) -> str:
    """A question of these tests, or what a site says before its partitions."""
    return Path(__file__).with_name("questions").joinpath(f"{name}.toml").read_text(encoding="utf-8")


CHUNKS, PAIR, CONTROL, ERRORS = map(told_in, ("chunks", "pair", "control", "errors"))
SLURM_SITE = told_in("slurm_site")
SCENE = CHUNKS[CHUNKS.index("[scene]") : CHUNKS.index("[sweep]")]
PAIR_APART = PAIR.replace("[scene]", "turns = false\n[scene]", 1)
PAIR_OF_BUILDS = PAIR.replace('variant = "nine"', 'variant = "published"\nprogram = "clang"')
FOUR_AND_NINE = PAIR[PAIR.index("[[series]]") :]


@dataclass(frozen=True)
class Workplace:
    """Paths of one test, and what a test does with them."""

    root: Path
    monkeypatch: pytest.MonkeyPatch
    contenders: list[Contender] = field(default_factory=list)
    """Of all contests of this process, in their order."""

    @property
    def results(self) -> Path:
        return self.root / "results"

    @property
    def program(self) -> Path:
        return self.root / "build" / "gcc" / "carom"

    @property
    def settings(self) -> Settings:
        return Settings(
            results=self.results, build=self.root / "build", questions=self.root / "questions", figures=False
        )

    @property
    def arguments(self) -> list[str]:
        return ["--results", "results", "--build", "build", "--questions", "questions"]

    def question(self, name: str, text: str) -> Path:
        path = self.root / "questions" / f"{name}.toml"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def behave(self, **environment: str) -> None:
        for name, value in environment.items():
            self.monkeypatch.setenv(name, value)

    def build(self, name: str = "gcc", extra: str = "") -> Path:
        """Put the fake program in its place; `extra` makes it another program."""
        self.behave(FAKE_RECORDS=str(FAKE.with_name("fake_records.json")))
        path = self.root / "build" / name / "carom"
        path.parent.mkdir(parents=True, exist_ok=True)
        text = FAKE.read_text(encoding="utf-8")
        path.write_text(f"#!{sys.executable} -IS\n{text}{extra}\n", encoding="utf-8")
        path.chmod(0o755)
        return path

    def records(self, experiment: str = "*") -> dict[str, dict[str, Any]]:
        """Point and block of whoever was measured -> what is told of it and of its process."""
        there = (one for one in self._contenders(experiment) if one["kind"] != "failure")
        return {f"{one['tags'].get('point')}-b{one['tags'].get('block')}": one for one in there}

    def failures(self) -> list[dict[str, Any]]:
        return [one for one in self._contenders("*") if one["kind"] == "failure"]

    def _contenders(self, experiment: str) -> Iterator[dict[str, Any]]:
        for path in self.files(experiment):
            record = json.loads(path.read_text(encoding="utf-8"))
            for one in record.pop("contenders"):
                kind = "failure" if "reason" in one else record["kind"]
                origin = record.get("provenance", {}) | one.get("provenance", {})
                yield record | one | {"kind": kind, "provenance": origin, "file": path.name}

    def files(self, experiment: str = "*", block: str = "") -> list[Path]:
        """The records, in the order of their paths."""
        name = f"*-b{block}.json" if block else "*.json"
        return sorted(self.results.glob(f"records/{experiment}/**/{name}"))

    def start(self, verb: str = "run", *more: str) -> "subprocess.Popen[str]":
        """The command line, as a user starts it."""
        return start([verb, *self.arguments, *more], self.root)

    def calls(self) -> list[dict[str, Any]]:
        """What the fake program was asked to do, if it logs."""
        return [json.loads(line) for line in (self.root / "log").read_text().splitlines()]

    def measured(self) -> int:
        """How many processes were run to measure a point."""
        return sum("--tag" in call["words"] for call in self.calls())

    def rows(self) -> dict[str, status.Row]:
        """Question -> its line of `carom study status`."""
        study = Study(self.settings)
        return {row.name: row for row in status.rows(study.store, study.experiments)}

    def is_whole(self) -> bool:
        """Whether every question has all the blocks that it was given, each of one session."""
        return all(row.done == row.planned for row in self.rows().values())


def damage(path: Path, kind: str) -> None:
    """Put something else in the place of a record, as one of `DAMAGES` says."""
    record = json.loads(path.read_text(encoding="utf-8"))
    path.unlink()
    if kind == "a folder":
        path.mkdir()
    elif kind == "a link to itself":
        path.symlink_to(path)
    elif kind == "torn":
        path.write_text(json.dumps(record)[:99], encoding="utf-8")
    else:
        other = {"schema_version": 0} if kind == "foreign" else {"kind": "failure"}
        path.write_text(json.dumps(record | other), encoding="utf-8")


DAMAGES = ("torn", "foreign", "of another kind", "a folder", "a link to itself")


def generated(point: Point) -> Scene:
    """The point's scene, which is no hard case."""
    assert isinstance(point.scene, Scene)
    return point.scene


def start(words: list[str], folder: Path, **environment: str) -> "subprocess.Popen[str]":
    """The command line in a folder: a fork, as whole as a new process but for the time it would take."""
    return forked(
        main, ["carom study", *words], cwd=folder, env={**os.environ, **environment}, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=hear_every_signal,
    )  # fmt: skip


def finish(process: "subprocess.Popen[str]") -> tuple[int, str, str]:
    """Exit code, standard output and standard error of a command that was started."""
    output, error = process.communicate(timeout=300)
    return process.returncode, output, error


def hear_every_signal() -> None:
    """Tests may themselves run under `nohup`, or in the background of a shell."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_DFL)


def until(happened: Callable[[], object], told: str, seconds: float = 60) -> None:
    """Wait for something; fails with `told` after so many seconds."""
    end = time.monotonic() + seconds
    while not happened():
        assert time.monotonic() < end, told
        time.sleep(0.01)


def no_child_is_left(workplace: Workplace) -> None:
    """The kernel ends the children of a process that died; it may take it a moment."""
    numbers = {call["pid"] for call in workplace.calls()}
    until(lambda: not any(map(is_running, numbers)), "a program outlived its runner", 5)


def is_running(number: int) -> bool:
    """Whether a process is there and no zombie."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.fixture
def empty_workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Workplace:
    place = Workplace(tmp_path, monkeypatch)
    measure = Contest.measure

    def noted(contest: Contest) -> list[Entrant]:
        place.contenders.extend(one.contender for one in contest.entrants)
        return measure(contest)

    monkeypatch.setattr(Contest, "measure", noted)
    monkeypatch.setattr(subprocess, "Popen", Forking)
    monkeypatch.setattr(os, "fsync", lambda _: None)
    place.build()
    place.behave(FAKE_LOG=str(tmp_path / "log"))
    return place


@pytest.fixture
def workplace(empty_workplace: Workplace) -> Workplace:
    empty_workplace.question("chunks", CHUNKS)
    empty_workplace.question("pair", PAIR)
    empty_workplace.question("control", CONTROL)
    return empty_workplace


class FakeAnalysis:
    """An analysis that wants as many blocks as the file `needed` of a workplace says."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def verdicts(self) -> Verdicts:
        if (self.root / "broken").exists():
            raise InputError("no statistics")
        blocks: dict[str, int] = {}
        for path in (self.root / "results" / "records").glob("*/*/*.json"):
            for one in json.loads(path.read_text())["contenders"]:
                name = one["tags"]["experiment"]
                blocks[name] = max(blocks.get(name, 0), one["tags"]["block"] + 1)
        opened, settled, said = {}, set(), {}
        for claim, needed in json.loads((self.root / "needed").read_text()).items():
            names = claim.split("+")
            least = min(blocks[name] for name in names)
            if least >= needed:
                settled.update(names)
                said[claim] = f"holds from {least} blocks"
            else:
                opened.update(dict.fromkeys(names, Open(least, least + 3, needed)))
        self._note("looks", json.dumps(blocks))
        return Verdicts(opened, frozenset(settled), said)

    def report(self, how_far: str = "") -> Path:
        if (self.root / "broken").exists():
            raise OSError(errno.ENOSPC, "No space left on device", "report.html")
        print("no ink", file=sys.stderr)
        self._note("reports", how_far)
        return Path("results/report.html")

    def _note(self, name: str, line: str) -> None:
        with (self.root / name).open("a") as file:
            print(line, file=file)


@pytest.fixture
def needing(workplace: Workplace) -> Workplace:
    """A workplace whose analysis wants as many blocks as the file `needed` says."""
    fake = FakeAnalysis(workplace.root)
    workplace.monkeypatch.setattr(session, "Analysis", lambda *_: fake)
    return workplace
