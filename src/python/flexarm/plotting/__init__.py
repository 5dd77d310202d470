"""Plots of runs, for Run.plot() and the command `flexarm plot` (docs/plot.md)."""
