"""The noise of one comparison, moderated by that of all others measured alike.

Four blocks hardly tell a standard deviation, a hundred comparisons of four blocks do. The variances of the
comparisons are taken as drawn from a scaled inverse chi-squared distribution, whose two parameters are
estimated from all of them; each comparison's variance is then shrunk towards it, and Student's t has the
degrees of freedom of both. Where the comparisons are unlike, the estimate says so: it has few degrees of
freedom, and hardly anything is borrowed. Source: Smyth, "Linear models and empirical Bayes methods for
assessing differential expression in microarray experiments", Stat. Appl. Genet. Mol. Biol. 3, 2004, equations
(6.1) and (6.2).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import digamma, polygamma

FEWEST_COMPARISONS = 8
"""With fewer there is nothing to borrow from."""
MOST_FREEDOM = 20.0
"""However alike the comparisons look: of so many is a prior that no comparison can escape."""


@dataclass(frozen=True)
class Prior:
    """What is known of a variance before it is measured, worth so many degrees of freedom."""

    freedom: float = 0.0
    variance: float = 0.0

    def moderated(self, variance: float, freedom: float) -> tuple[float, float]:
        """Return a measured variance shrunk towards the prior's, with the degrees of freedom of both."""
        both = self.freedom + freedom
        return (self.freedom * self.variance + freedom * variance) / both, both


NOTHING_KNOWN = Prior()


def fit(variances: ArrayLike, freedoms: ArrayLike) -> Prior:
    """Return the prior of comparisons with these variances, each with its degrees of freedom."""
    variance, freedom = (np.asarray(one, dtype=float) for one in (variances, freedoms))
    kept = (variance > 0) & (freedom > 0)
    if kept.sum() < FEWEST_COMPARISONS:
        return NOTHING_KNOWN
    half = freedom[kept] / 2
    logs = np.log(variance[kept]) - digamma(half) + np.log(half)
    excess = float(logs.var(ddof=1) - polygamma(1, half).mean())
    prior = 2 * _inverse_trigamma(excess)
    return Prior(prior, float(np.exp(logs.mean() + digamma(prior / 2) - np.log(prior / 2))))


def _inverse_trigamma(value: float) -> float:
    """Return x with trigamma(x) = value, at most half of `MOST_FREEDOM`."""
    most = MOST_FREEDOM / 2
    if value <= polygamma(1, most):
        return most
    return float(brentq(lambda x: polygamma(1, x) - value, 1e-6, most))
