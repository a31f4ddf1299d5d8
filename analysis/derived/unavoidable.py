"""The work that a time step cannot avoid, phase by phase, whatever the variant: a lower bound for each.

What is counted, for n discs, k overlapping pairs and p pair resolves a step, with numbers of b bytes (8 in
double precision, 4 in float) and names of discs of INDEX bytes:

move      reads positions and velocities (4b a disc) and writes positions (2b);
          x += v dt takes a multiplication and an addition in each direction: 4 operations a disc.
bin       reads positions (2b a disc) and writes where the disc belongs (INDEX);
          its box is two multiplications by the inverse of the boxes' side: 2 a disc.
find      reads positions (2b a disc) and writes the two discs of each overlap (2 INDEX a pair);
          an overlap is not known before |d|^2 <= (2r)^2 was asked: 2 subtractions for d, 2 multiplications
          and an addition for |d|^2: 5 a pair. Pairs that turn out to be apart are avoidable, so they do not
          count.
resolve   reads each overlap (2 INDEX a pair), positions and velocities of the discs in one (4b), writes the
          velocities that change (2b a disc);
          every overlap is asked once whether it approaches, (v2 - v1) . d < 0: 2 subtractions each for d and
          v2 - v1, 2 multiplications and an addition: 7 a pair; every resolve needs |d|^2 (3), s (a division),
          s d (2) and its addition to both velocities (4): 10. Asking again after a change is avoidable, so it
          does not count.

Comparisons, and the walls' (which are nothing else), are not counted. How many discs have an overlap follows
from the mean number 2k / n of overlaps of a disc: for discs placed at random it is Poisson distributed, so
that a part 1 - exp(-2k / n) has one at least. The discs that change are estimated alike, from the pairs that
can have been resolved, min(p, k).

A phase reads what it needs once and writes what it makes once. Phases that are fused could do with less: a
step as a whole must only read and write every disc once, 8b.
"""

import numpy as np
import pandas as pd

INDEX = 4
PHASES = ("move", "bin", "find", "resolve")


def unavoidable(runs: pd.DataFrame) -> pd.DataFrame:
    """Return one row a run (of `tables.runs`) and phase: `file`, `phase`, `bytes`, `operations` and
    `working_set` of a step, what it comes back to: positions, velocities, the order of discs, overlaps.
    """
    steps = runs["steps"] * runs["substeps"]
    n, k, p = runs["particles"], runs["overlaps"] / steps, runs["pair_resolves"] / steps
    b = runs["precision"].map({"double": 8, "float": 4})

    def among(pairs: pd.Series) -> pd.Series:
        """Return how many discs are in at least one of so many pairs of discs placed at random."""
        return n * -np.expm1(-2 * pairs / n)

    work = {
        "move": (n * 6 * b, n * 4.0),
        "bin": (n * (2 * b + INDEX), n * 2.0),
        "find": (n * 2 * b + k * 2 * INDEX, k * 5.0),
        "resolve": (
            k * 2 * INDEX + among(k) * 4 * b + among(np.minimum(p, k)) * 2 * b,
            k * 7.0 + p * 10.0,
        ),
    }
    working_set = n * (4 * b + INDEX) + k * 2 * INDEX
    tables = [
        runs[["file"]].assign(phase=phase, bytes=read, operations=done, working_set=working_set)
        for phase, (read, done) in work.items()
    ]
    return pd.concat(tables, ignore_index=True)
