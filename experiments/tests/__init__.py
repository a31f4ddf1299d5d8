"""Tests of the planner and the runner."""
