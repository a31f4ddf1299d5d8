"""What every room uses and what knows nothing of the study.

Errors that a user is meant to see, files that are whole or not there, child processes, TOML checked against
a schema. Uses no other room.
"""
