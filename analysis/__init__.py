"""What the records mean: tables, statistics, figures, claims and the report."""
