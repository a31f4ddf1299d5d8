"""Verbs that are more than a figure, a claim or the report: compare, movie, performance.

Uses all other rooms.
"""
