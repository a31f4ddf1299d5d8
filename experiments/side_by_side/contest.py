"""Who runs when, who minds being stopped, which runs count: programs measured beside each other.

What may be sliced takes turns (`carom processes`). Where nobody says whether a program may be, it runs once
undisturbed first. It then has a stretch of its own, by itself, for each of these reasons:
 - it is idle for more than half of its time, and not for want of a processor: what it waits for goes on while
   it stands still;
 - it succeeds undisturbed and fails in slices: a wait that was interrupted, a partner that gave it up;
 - a run in slices is further from all undisturbed ones than noise explains: by a tenth of the time, or by a
   twentieth of the time for each second of CPU time, which noise of the machine hardly changes. Then it runs
   undisturbed again, and all take turns again, up to three times in all: it may be noise, or that it waits
   for one of the others, which stands still then. Only where no time all of them agree it counts, of each
   that disagreed.
A run that told so and was undisturbed counts; one in slices that agrees counts as well, unless nobody else is
left.

Stretches are in random order, among themselves and with the one of all slices. What has `rounds` runs so
often, spread evenly over all of that at random. What times itself within short processes has several rounds
after it, each in an order of its own: so many that the longest has had a second, but no more than anyone's
`most_rounds`.
"""

import contextlib
import itertools
import math
import random
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from experiments.plan.series import Manner
from experiments.side_by_side.benchmark_time import benchmark_time, unlike_times
from experiments.side_by_side.printed_time import printed_time
from experiments.side_by_side.run_result import RunResult
from experiments.side_by_side.sampler import ProcessCommand, Sampler, SamplerError
from experiments.side_by_side.stated_time import StatedTime
from support.errors import InputError

LEFT_ALONE = "nothing was left that it could take turns with"
"""The one reason for a stretch of its own that the others are, and not the program itself."""

ATTEMPTS = 3
"""Runs of either kind before it is said that a program minds being stopped."""

_LEAST_BUSY = LEAST_IDLE = 0.5
"""Processors, of a program and of the machine beside it: below, or above, it waits for something else."""
_SHORTEST_TO_TELL = 0.002
_MARGIN_OF_TIME = 1.1
"""Another speed of the machine changes the time by any factor, though rarely three times in a row."""
_MARGIN_OF_WAITING = 1.05
"""It changes time and CPU time alike: their quotient tells of waiting."""
_LEAST_CPU_SECONDS = 0.05
"""Of less than some ticks the quotient is noise."""
_ENDED_APART = 0.1
_SECONDS_OF_ROUNDS = 1.0
_MOST_ROUNDS_OF_A_BENCHMARK = 20
_SECONDS_BEHIND = 2.0
"""What goes before and after a run may leave behind for so long."""


@dataclass(frozen=True)
class Contender(Manner):
    """A program that is measured beside others."""

    words: tuple[str, ...]
    folder: str = ""
    environment: Mapping[str, str] = field(default_factory=dict)
    most_seconds: float = 600.0
    warm_ups: int = 0
    """Runs before the first that counts."""
    expected_seconds: float = 0.0
    """How long it takes undisturbed, or 0 where nobody knows."""
    output: Path | None = None
    """The file that the benchmark writes."""

    @property
    def may_be_sliced(self) -> bool:
        """Whether nothing keeps it from taking turns, as far as is known beforehand. What times itself would
        count as its own time what it stands still.
        """
        return not self.times_itself and not self.rounds and self.turns is not False

    @property
    def most_rounds(self) -> int:
        """Of one that times itself within short processes, how often it runs at most."""
        return _MOST_ROUNDS_OF_A_BENCHMARK if self.benchmark is not None and self.rounds is None else 1


@dataclass
class Attempt:
    """A run, with why it does not count."""

    failure: str = ""
    folder: str = ""
    result: RunResult | None = None


@dataclass
class Entrant:
    """A contender, what is known of it meanwhile, and what became of it."""

    contender: Contender
    printed: Path
    """The file for its standard output, where its time is to be found there."""
    failure: str = ""
    """Why no run counts."""
    exit_code: int = 1
    """Of its last run, as one that failed."""
    runs: list[RunResult] = field(default_factory=list)
    """Those that count, one but where it has several rounds."""
    stated: list[StatedTime] = field(default_factory=list)
    """Of each run; empty if the time from outside is the one that counts."""
    is_sliced: bool = False
    undisturbed: str = ""
    """Why it had a stretch of its own although it might have been sliced."""
    looks: list[RunResult] = field(default_factory=list)
    """Of one that is looked at, the runs without a pause."""
    attempts: list[Attempt] = field(default_factory=list)
    """Of one that takes turns, the runs in slices."""

    @property
    def told_seconds(self) -> list[float]:
        """Of each run that counts, the time that it says, or the one from outside."""
        return [one.seconds for one in self.stated] or [one.wall_seconds for one in self.runs]

    @property
    def is_open(self) -> bool:
        """Whether it has neither a run that counts nor failed."""
        return not self.runs and not self.failure

    @property
    def expected_seconds(self) -> float:
        """How long it takes undisturbed."""
        return self.looks[-1].wall_seconds if self.looks else self.contender.expected_seconds

    def disagrees(self, attempt: int) -> bool:
        """Whether a run in slices is further from all without a pause than noise explains."""
        result = self.attempts[attempt].result
        return bool(self.looks) and result is not None and may_disagree(self.looks, [result])

    def keep(self, result: RunResult, undisturbed: str = "") -> None:
        """Let a run count, if it says its time where it is to."""
        self.undisturbed = undisturbed
        try:
            stated = self._stated_time(result)
        except InputError as error:
            self.failure, self.exit_code = str(error), 1
            return
        if stated is not None:
            self.stated.append(stated)
        self.runs.append(result)

    def _stated_time(self, result: RunResult) -> StatedTime | None:
        its = self.contender
        if its.benchmark is not None:
            assert its.output is not None
            try:
                report = its.output.read_bytes()
                its.output.unlink()  # so that nothing is taken for what the next run wrote
            except OSError as error:
                told = f"cannot be read ({error.strerror}), expected a readable file"
                raise InputError(f"{its.output}: {told}") from error
            return benchmark_time(report, its.benchmark)
        if its.pattern is None:
            return None
        kept = self.printed.stat().st_size if self.printed.exists() else 0
        if kept < result.output_bytes:
            told = f"of which only {kept} could be kept to look for it, expected less"
            raise InputError(f"time: found {result.output_bytes} bytes of standard output, {told}")
        with self.printed.open("rb") as lines:
            return StatedTime(printed_time(lines, its.pattern, its.unit_seconds))


class Contest:
    """All contenders while they are measured. `slice_seconds` is how long the shortest runs before the next
    does, `seed` that of the order of slices and of stretches, and `scratch` a folder for what is printed.
    """

    def __init__(
        self,
        sampler: Sampler,
        contenders: Sequence[Contender],
        slice_seconds: float,
        seed: int,
        scratch: Path,
    ) -> None:
        self._sampler = sampler
        self._slice_seconds = slice_seconds
        self._random = random.Random(seed)
        self.entrants = [
            Entrant(one, scratch.absolute() / f"{number}.printed") for number, one in enumerate(contenders)
        ]

    def measure(self) -> list[Entrant]:
        """What became of each, in their order."""
        try:
            for one in self._in_random_order():
                self._warm_up(one)
            if len(self._sliceable()) > 1:
                for one in self._in_random_order():
                    self._look_at(one)
            self._first_round()
            self._further_rounds()
        except SamplerError as error:
            for one in self.entrants:
                one.failure = one.failure or str(error)
        _refuse_unlike_times(self.entrants)
        return self.entrants

    def _in_random_order(self) -> list[Entrant]:
        return self._random.sample(self.entrants, len(self.entrants))

    def _sliceable(self) -> list[Entrant]:
        return [one for one in self.entrants if one.is_open and one.contender.may_be_sliced]

    def _run(self, one: Entrant) -> RunResult | None:
        """A whole run without a pause. None if it failed, which is then what became of the contender."""
        [attempt] = self._run_together([one])
        one.failure = attempt.failure
        return None if attempt.failure else attempt.result

    def _warm_up(self, one: Entrant) -> None:
        for _ in range(one.contender.warm_ups):
            if one.is_open:
                self._run(one)

    def _look_at(self, one: Entrant) -> None:
        """A first run of what nobody knows."""
        if not one.is_open or not one.contender.may_be_sliced or one.contender.turns is not None:
            return
        result = self._run(one)
        if result is None:
            return
        if idle := why_idle(result):
            one.keep(result, idle)
        else:
            one.looks.append(result)

    def _first_round(self) -> None:
        """Whether it has several runs or one, those of each are spread evenly over the whole, at random
        within an even share.
        """
        sliced = self._sliceable()
        sliced = sliced if len(sliced) > 1 else []
        stretches: list[tuple[float, Callable[[], None]]] = []
        if sliced:
            stretches.append((self._random.random(), lambda: self._take_turns(sliced)))
        for one in self.entrants:
            if one.is_open and one not in sliced:
                rounds = one.contender.rounds or 1
                for number in range(rounds):
                    when = (number + self._random.random()) / rounds
                    stretches.append((when, lambda one=one: self._stretch(one)))  # type: ignore[misc]
        for _, run in sorted(stretches, key=lambda stretch: stretch[0]):
            run()

    def _stretch(self, one: Entrant) -> None:
        """Of one that is left over from those that were to take turns the undisturbed run is there."""
        if one.looks:
            one.keep(one.looks[0], LEFT_ALONE)
        elif not one.failure and (result := self._run(one)) is not None:
            one.keep(result)

    def _take_turns(self, sliced: Sequence[Entrant]) -> None:
        """All of them in slices, and all again while one takes another time than undisturbed: that may be
        noise, or it waits for one of the others, which stands still then.
        """
        group = list(sliced)
        for number in range(ATTEMPTS):
            for one, attempt in zip(group, self._in_known_slices(group), strict=True):
                one.attempts.append(attempt)
                _judge_failure(one, attempt)
            for one in group:
                if number + 1 < ATTEMPTS and one.is_open and one.disagrees(number):
                    one.looks += filter(None, [self._run(one)])
            group = [one for one in group if one.is_open]
            if len(group) < 2 or not any(one.disagrees(number) for one in group):
                break
        self._judge(group, number + 1)

    def _in_known_slices(self, group: Sequence[Entrant]) -> list[Attempt]:
        """In slices, once more where it turns out that their lengths were not known."""
        lengths = [one.expected_seconds for one in group]
        attempts = self._run_together(group, lengths)
        results = [one.result for one in attempts if one.result is not None and not one.failure]
        ended_apart = any(one.seconds_alone > _ENDED_APART * one.wall_seconds for one in results)
        if all(lengths) or len(results) < len(group) or not ended_apart:
            return attempts
        return self._run_together(group, [one.wall_seconds for one in results])

    def _judge(self, group: Sequence[Entrant], attempts: int) -> None:
        """Which runs in slices may stand: those of an attempt in which all agree. Where there is none,
        nobody's that disagreed in any: which of two that wait for one another has to is chance.
        """
        agree = [n for n in range(attempts) if not any(one.disagrees(n) for one in group)]
        number = agree[0] if agree else attempts - 1
        if not agree:
            group = [one for one in group if not _keeps_undisturbed(one)]
            if len(group) == 1 and group[0].looks:
                self._stretch(group[0])
                return
        for one in group:
            result = one.attempts[number].result
            assert result is not None
            one.is_sliced = True
            one.keep(result)

    def _further_rounds(self) -> None:
        several = [one for one in self.entrants if one.contender.most_rounds > 1 and not one.failure]
        if not several:
            return
        longest = max(one.runs[0].wall_seconds for one in several)
        wanted = math.ceil(_SECONDS_OF_ROUNDS / max(longest, 1e-9))
        for number in range(1, min(wanted, max(one.contender.most_rounds for one in several))):
            for one in self._in_random_order():
                if number < one.contender.most_rounds:
                    self._stretch(one)

    def _run_together(self, group: Sequence[Entrant], lengths: Sequence[float] = ()) -> list[Attempt]:
        """A run of each, prepared and concluded, in slices if they are several."""
        with contextlib.ExitStack() as stack:
            attempts = [self._prepared(one.contender, stack) for one in group]
            all_of_them = zip(group, attempts, lengths or [0.0] * len(group), strict=True)
            ready = [each for each in all_of_them if not each[1].failure]
            commands = [_command_of(*each) for each in ready]
            seed = self._random.getrandbits(64)
            results = self._sampler.run(commands, self._slice_seconds, seed) if ready else []
            for (one, attempt, _), result in zip(ready, results, strict=True):
                its = one.contender
                attempt.result = result
                attempt.failure = result.why_failed(its.exit_codes or (0,), its.folder, its.most_seconds)
                one.exit_code = result.failure_code
            for one, attempt in zip(group, attempts, strict=True):
                its = one.contender
                concluded = self._run_beside(its, "conclude", its.conclude, attempt.folder)
                attempt.failure = attempt.failure or concluded
        return attempts

    def _prepared(self, its: Contender, stack: contextlib.ExitStack) -> Attempt:
        """The run that is to be, in its folder, once what prepares it was run."""
        folder = its.folder
        if its.fresh_folder:
            temporary = tempfile.TemporaryDirectory(prefix="carom-run-", ignore_cleanup_errors=True)
            folder = stack.enter_context(temporary)
        return Attempt(self._run_beside(its, "prepare", its.prepare, folder), folder)

    def _run_beside(self, its: Contender, what: str, words: Sequence[str], folder: str) -> str:
        """Run what goes before or after a run; returns why it failed."""
        if not words:
            return ""
        command = ProcessCommand(words, folder, its.environment, its.most_seconds, _SECONDS_BEHIND)
        why = self._sampler.run([command])[0].why_failed((0,), folder, its.most_seconds)
        return f"{what}: {why}" if why else ""


def why_idle(undisturbed: RunResult) -> str:
    """Why it is not to be stopped, since it waits for most of its time; empty if it does not, or if nobody
    can tell: of a program of less than two milliseconds, and where it may have waited for a processor, as all
    of them were busy.
    """
    wall = undisturbed.wall_seconds
    if wall < _SHORTEST_TO_TELL or undisturbed.idle_seconds / wall < LEAST_IDLE:
        return ""
    return idle_told(undisturbed.cpu_seconds / wall)


def idle_told(busy: float) -> str:
    """Why what keeps so many processors busy is not to be stopped; empty if it is."""
    if busy >= _LEAST_BUSY:
        return ""
    told = f"it computes for only {100 * busy:.0f} % of its time"
    return f"{told}, and what it waits for would go on while it stands still"


def may_disagree(undisturbed: Sequence[RunResult], in_slices: Sequence[RunResult]) -> bool:
    """Whether all runs in slices are so much shorter, or so much longer, than all without a pause that noise
    does not explain it. What they waited for a processor does not count.
    """
    return any(
        max(ones) * margin < min(others)
        for value, margin in ((_own_seconds, _MARGIN_OF_TIME), (_waiting, _MARGIN_OF_WAITING))
        for ones, others in itertools.permutations([[*map(value, undisturbed)], [*map(value, in_slices)]])
    )


def _own_seconds(result: RunResult) -> float:
    return result.own_seconds


def _waiting(result: RunResult) -> float:
    is_known = result.cpu_seconds > _LEAST_CPU_SECONDS
    return result.own_seconds / result.cpu_seconds if is_known else 1.0


def _keeps_undisturbed(one: Entrant) -> bool:
    """Lets its undisturbed run count if it disagreed in any attempt."""
    apart = [attempt.result for n, attempt in enumerate(one.attempts) if one.disagrees(n)]
    if apart:
        still, sliced = (min(one.own_seconds for one in runs if one) for runs in (one.looks, apart))
        told = (
            "it takes another time where it is stopped now and then and the others stand still while it "
            f"runs: {still:.3g} s without a pause, {sliced:.3g} s in slices"
        )
        one.keep(one.looks[-1], told)
    return bool(apart)


def _judge_failure(one: Entrant, attempt: Attempt) -> None:
    """Of one that failed in slices, what became of it."""
    if attempt.failure and not one.looks:
        one.failure = attempt.failure
    elif attempt.failure:
        told = f"a run in slices failed ({attempt.failure}), one without a pause did not"
        one.keep(one.looks[-1], told)


def _command_of(one: Entrant, attempt: Attempt, length: float) -> ProcessCommand:
    its = one.contender
    printed = str(one.printed) if its.pattern is not None else ""
    return ProcessCommand(
        its.words,
        attempt.folder,
        its.environment,
        its.most_seconds,
        output_file=printed,
        expected_seconds=length,
    )


def _refuse_unlike_times(entrants: Sequence[Entrant]) -> None:
    """Times of unlike versions of a library are none of one kind: none of them counts."""
    for one, other in itertools.combinations([one for one in entrants if one.stated], 2):
        if why := unlike_times(one.stated[-1], other.stated[-1]):
            one.failure = other.failure = why
