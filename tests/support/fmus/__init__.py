"""FMUs of every kind, built in the test session; README.md is the menu."""

from fmu_zoo.cars import PHASES, Car
from fmu_zoo.faults import FAULTS
from fmu_zoo.zoo import Zoo

__all__ = ["FAULTS", "PHASES", "Car", "Zoo"]
