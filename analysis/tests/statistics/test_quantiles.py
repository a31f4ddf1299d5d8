"""The same numbers as those of scipy.stats, which is not loaded."""

import subprocess
import sys

import numpy as np
from scipy import stats

from analysis.statistics import quantiles

CHANCES = np.concatenate([np.linspace(1e-12, 1 - 1e-12, 201), 10.0 ** -np.arange(1, 16)])
VALUES = np.linspace(-30, 30, 101)


def test_they_are_those_of_scipy_stats() -> None:
    assert np.array_equal(quantiles.normal(CHANCES), stats.norm.ppf(CHANCES))
    assert np.array_equal(quantiles.normal_below(VALUES), stats.norm.cdf(VALUES))
    for freedom in (1, 2, 5, 8, 13, 47, 999):
        assert np.array_equal(quantiles.student(CHANCES, freedom), stats.t.ppf(CHANCES, freedom))
        assert np.array_equal(quantiles.chi_squared(CHANCES, freedom), stats.chi2.ppf(CHANCES, freedom))
        beyond = [quantiles.student_beyond(value, freedom) for value in VALUES]
        assert np.array_equal(beyond, stats.t.sf(VALUES, freedom))


def test_a_report_loads_neither_it_nor_what_draws_a_pdf() -> None:
    slow = "{'scipy.stats', 'matplotlib.backends.backend_pdf'}"
    code = f"import sys, analysis.report; print({slow} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
