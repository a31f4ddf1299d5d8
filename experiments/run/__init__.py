"""The runner: checks a variant, measures a point, shares out the time, tells what is done.

Uses `results`, `plan` and `support`; knows nothing of Slurm.
"""
