"""What the cars of the zoo have to do by their equation of motion."""

from __future__ import annotations

from math import exp

SAVING = {"1.0": "", "2.0": "canGetAndSetFMUstate", "3.0": "canGetAndSetFMUState"}


def moved(force, time, speed=0.0, mass=1000.0, friction=100.0):
    """Position and speed by the analytic solution of M v' + alpha v = F."""
    final, decay = force / friction, exp(-friction / mass * time)
    return (
        final * time + (speed - final) * mass / friction * (1.0 - decay),
        final + (speed - final) * decay,
    )


def saving(version, able=True):
    """The capability flag for states."""
    return {SAVING[version]: str(able).lower()} if SAVING[version] else {}
