"""Estimates with intervals, verdicts against a margin, trends, scalability and noise; tables in, tables
out.
"""
