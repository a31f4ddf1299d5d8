"""The same study as job arrays: what is missing becomes jobs, a task of a job runs its part.

Uses all other rooms.
"""
