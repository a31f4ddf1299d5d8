"""Verbs that are more than a figure, a claim or the report: what is open, export, movie.

Uses all other rooms.
"""
