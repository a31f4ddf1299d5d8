"""What the records mean: tables, statistics, figures, claims and the report."""

import os

# Figures are drawn in forks of the process (support/parallel.py), which must have no other threads by then.
# The library asks once, when numpy is first imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
