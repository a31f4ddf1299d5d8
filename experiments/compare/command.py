"""The verb `compare`: blocks until all is settled or the time is over, then the result."""

import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.compare import exports
from experiments.compare.answer import Answer, ask
from experiments.compare.blocks import Blocks, keep_addresses, shell_seconds
from experiments.compare.options import Asked, parse
from experiments.compare.question import experiment_of
from experiments.compare.texts import blocks_said, change, duration, result
from experiments.plan.plan import Surroundings
from experiments.plan.program import GENERATOR, find_programs
from experiments.plan.scale import find_scale
from experiments.plan.scenes import SceneFolder
from experiments.plan.site import load_site, this_machine
from experiments.results.store import Store, new_session
from experiments.run.progress import about, warn
from experiments.run.runner import Runner
from experiments.support import process
from experiments.support.places import BUILDS, analysis
from experiments.support.process import Coprocess
from support.errors import InputError, Interrupted

COMMAND_FAILED, WITHDRAWN = 2, 5


def compare(arguments: Sequence[str]) -> int:
    """Run the verb; returns the exit code: 0 measured, 2 a command failed, 5 the reference differs from
    itself. Raises InputError before anything is measured.
    """
    asked = parse(arguments)
    exports.require_places(asked.exports)
    return measured(asked)[0]


def measured(asked: Asked) -> tuple[int, Answer]:
    """Measure and tell the result; returns the exit code and what the last look found."""
    if asked.fixed_layout:
        keep_addresses()
    with tempfile.TemporaryDirectory(prefix="carom-compare-") as folder, _set_up(asked):
        return _measured(asked, Path(folder))


def _measured(asked: Asked, folder: Path) -> tuple[int, Answer]:
    where = load_site("local")
    programs = find_programs(where, BUILDS)
    generator = programs[GENERATOR]
    if generator.sha256 is None:
        raise InputError(generator.remedy)
    around = Surroundings(where, this_machine(), programs, find_scale("paper"))
    experiment = experiment_of(asked, around)
    store = Store(folder, new_session())
    with store.opened(), Coprocess(analysis("follow", "--results", str(folder))) as judge:
        scenes = SceneFolder(folder / "scenes", store.temporary, str(generator.sha256))
        blocks = Blocks(experiment, store, Runner(store, scenes, generator, asked.most_seconds))
        with _Line(asked.quiet) as line:
            line.show("making ready")
            answer = ask(judge)  # it takes seconds to load what it needs
            answer, stopped = _until_settled(asked, blocks, judge, answer, line)
    said = result(asked, answer, blocks.runs, blocks.done, blocks.seconds)
    for text in [*said, *_remarks(asked)]:
        print(text)
    exports.write(asked, answer, blocks.runs, around.machine.name, said)
    for key, reason in blocks.failed.items():
        runs = len(blocks.runs[key].seconds)
        name = f"{key[0]}, {asked.cases[key[1]]}" if asked.cases else key[0]
        warn(f"carom: {name}: failed after {runs} run{'' if runs == 1 else 's'}: {reason}")
    if stopped is not None:
        return 128 + stopped, answer
    return COMMAND_FAILED if blocks.failed else WITHDRAWN if answer.is_withdrawn else 0, answer


def _until_settled(
    asked: Asked, blocks: Blocks, judge: Coprocess, answer: Answer, line: "_Line"
) -> tuple[Answer, int | None]:
    """Measure; returns the last answer, and the signal that stopped it before its end, if one did."""
    blocks.begin()
    try:
        while blocks.run(vary_layout=not asked.fixed_layout):
            if blocks.done == answer.next:
                answer = ask(judge)
                if answer.is_enough(asked.margin, one_sided=asked.one_sided):
                    break
            line.show(_so_far(asked, blocks, answer))
            if blocks.seconds * (1 + 1 / blocks.done) > asked.seconds:
                break
    except Interrupted as stopped:
        return answer, stopped.signal_number
    return answer, None


def _so_far(asked: Asked, blocks: Blocks, answer: Answer) -> str:
    """In one line: what is known, and when more will be."""
    left = asked.seconds - blocks.seconds
    told = f"{blocks_said(blocks.done)}, {blocks.seconds:.0f} s"
    if not answer.commands:
        until = (answer.next - blocks.done) * blocks.seconds / blocks.done
        return f"{told}; a first interval in {about(until)}"
    worst = min(answer.commands, key=lambda one: one.is_settled)
    known = f"{told}; {asked.cases[worst.case] if asked.cases else worst.name} {change(worst)}"
    if answer.needed is None:
        return f"{known}; {about(left)} left"
    until = (answer.needed - blocks.done) * blocks.seconds / blocks.done
    return f"{known}; {about(min(until, left))} left"


def _remarks(asked: Asked) -> list[str]:
    """What is to be known of how it was measured."""
    if any(one.has_shell for one in asked.commands):
        took = duration(shell_seconds())
        return [f"  a shell starts lines that are more than plain words; its start takes {took}, and counts"]
    return []


@contextlib.contextmanager
def _set_up(asked: Asked) -> Iterator[None]:
    """Run what comes once before everything, and what comes after it whatever happens."""
    try:
        _once("--setup", asked.setup)
        yield
    finally:
        _once("--cleanup", asked.cleanup)


def _once(option: str, line: str | None) -> None:
    if line is not None:
        done = process.run(("sh", "-c", line), dict(os.environ))
        if done.exit_code != 0:
            raise InputError(f"{option}: {line}: {done.reason}")


class _Line:
    """One line on a terminal that tells how far it is, drawn between blocks only; a context manager."""

    def __init__(self, quiet: bool) -> None:
        self._is_shown = sys.stderr.isatty() and not quiet

    def __enter__(self) -> "_Line":
        return self

    def __exit__(self, *_: object) -> None:
        self.show("")

    def show(self, text: str) -> None:
        """Put the text in the place of the one before."""
        if self._is_shown:
            width = os.get_terminal_size(sys.stderr.fileno()).columns
            sys.stderr.write(f"\r\x1b[K{text[: max(1, width - 1)]}")
            sys.stderr.flush()
