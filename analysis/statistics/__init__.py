"""Estimates with intervals, verdicts against a margin, trends, scalability, noise; tables in, tables out."""
