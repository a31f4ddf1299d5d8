"""Why Slurm took no job, as far as its words tell, and what helps."""

import re
from typing import Self

from experiments.support.process import TIMED_OUT, Completed
from support.errors import InputError

_AGAIN = "`carom study resume` tries again"

_FULL = re.compile(r"temporarily un|queue (is )?full", re.IGNORECASE)
_AWAY = re.compile(
    r"unable to contact|connection refused|timed out|zero bytes|communication connection|receive failure",
    re.IGNORECASE,
)
_POLICY = re.compile(r"\b(?:Assoc|QOS)\w*Limit\b")
"""Which limit it was, on a line of its own before the general one."""


class RefusedError(InputError):
    """A job that was not taken. `too_many`: fewer tasks may be taken. `is_away`: nobody answered, so that no
    other job will be taken now. `is_unsure`: it may have been taken all the same.
    """

    def __init__(
        self, text: str, *, too_many: bool = False, is_away: bool = False, is_unsure: bool = False
    ) -> None:
        super().__init__(text)
        self.too_many = too_many
        self.is_away = is_away
        self.is_unsure = is_unsure

    @classmethod
    def of(cls, done: Completed) -> Self:
        """What sbatch said."""
        words, limit = words_of(done), _POLICY.search(done.error)
        if limit is not None and limit[0] not in words:
            words += f" ({limit[0]})"
        if "SubmitJob" in limit[0] if limit is not None else "job submit limit" in done.error:
            return cls(
                f"{words}; `carom study resume` submits the rest once jobs of yours have ended", too_many=True
            )
        if done.exit_code == TIMED_OUT:
            # sbatch itself tries again for minutes while the cluster takes no more jobs.
            told = f"{words}; the queue is full, or the controller is away: {_AGAIN}"
            return cls(told, is_away=True, is_unsure=True)
        if _AWAY.search(done.error):
            is_unsure = "unable to contact" not in done.error.lower()
            return cls(f"{words}; {_AGAIN} once it answers", is_away=True, is_unsure=is_unsure)
        if _FULL.search(done.error):
            return cls(f"{words}; the queue is full: {_AGAIN}")
        return cls(words)


def words_of(done: Completed) -> str:
    """What a command said last, after its name."""
    name = done.command[0]
    return f"{name}: {done.reason.removeprefix(f'{name}: ')}"
