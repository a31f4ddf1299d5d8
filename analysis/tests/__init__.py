"""Tests of the analysis, on synthetic records with known effects."""
