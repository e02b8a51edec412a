"""Driving a vehicle FMU in this process: its start, its steps, its motion, and what no car does."""
