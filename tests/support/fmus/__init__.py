"""FMUs of every kind, built in the test session; README.md is the menu."""

from support.fmus.cars import PHASES, Car
from support.fmus.faults import FAULTS
from support.fmus.zoo import Zoo

__all__ = ["FAULTS", "PHASES", "Car", "Zoo"]
