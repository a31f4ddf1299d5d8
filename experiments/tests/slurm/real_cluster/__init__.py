"""A real Slurm for the tests, and the tests that need it."""
