"""Driving an FMU: inverse maps, steps, what comes out, and what no car does."""
