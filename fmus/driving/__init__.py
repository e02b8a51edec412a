"""The driving of a vehicle FMU in this process: start, steps, motion, and plausibility checks."""
