"""What every room uses and what knows nothing of the study.

Child processes, TOML checked against a schema, where the other parts of Carom are. Uses no other room.
"""
