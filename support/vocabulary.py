"""The words that pass between the runner and the analysis, in records and in results folders."""

SCALES = ("paper", "quick")
"""The sizes of a study, the larger first."""

CONTROL = "control"
"""The question that measures the same under two labels."""

COUNTS = "counts"
"""The kind of which nothing is timed for comparison: one process counts the work of many points."""

PAUSES = "pauses"
"""The kind that compares programs in slices of time with the same ones without a pause."""

PLAN = "plan.json"
"""The file of a results folder that tells how many blocks each experiment was given."""

WALL, OWN = "wall", "own"
"""The clocks by which commands are judged: all time that passes, or that less waiting for a processor."""

AGAIN = " again"
"""Behind the name of the reference where `carom compare` runs it under a second one."""

ASKED = "asked.json"
"""The file of a results folder with what `carom compare` asks beside its questions: `cases`, the names of the
cases in the order of their numbers, and `contrasts`, the sums of logarithms that are to be judged, each with
a `name` and with `weights` by series.
"""
