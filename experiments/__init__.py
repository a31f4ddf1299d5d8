"""What to measure and where: one TOML per question, planned, run, resumed and told about."""
