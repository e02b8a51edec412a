"""Driving a vehicle FMU in this process: start, steps, motion, and checks of plausibility."""
