"""A car for PythonFMU3 that feels the road: FMI 3.0, its grade in rad or as a percentage."""

from math import atan, sin

from pythonfmu3 import (
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3Status,
    Fmi3StepResult,
    Fmi3Variability,
)
from pythonfmu3.unit import Unit


class HillCar(Fmi3Slave):
    """M v' + alpha v = force - M g sin(grade); both inputs add up."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        self.force, self.grade, self.steepness = 0.0, 0.0, 0.0
        self.v0, self.speed, self.position = 0.0, 0.0, 0.0
        self.register_units(
            [
                Unit("N", kg=1, m=1, s=-2),
                Unit("m/s", m=1, s=-1),
                Unit("m", m=1),
                Unit("rad", rad=1),
                Unit("%", factor=0.01),
            ]
        )
        changing = {"variability": Fmi3Variability.continuous}
        clock = {"causality": Fmi3Causality.independent}
        self.register_variable(Float64("time", **clock, **changing))
        told = {"causality": Fmi3Causality.input, "start": 0.0}
        for name, unit in (("force", "N"), ("grade", "rad"), ("steepness", "%")):
            self.register_variable(Float64(name, unit=unit, **told, **changing))
        for name, unit in (("speed", "m/s"), ("position", "m")):
            out = {"causality": Fmi3Causality.output}
            self.register_variable(Float64(name, unit=unit, **out, **changing))
        fixed = {"causality": Fmi3Causality.parameter, "variability": Fmi3Variability.fixed}
        self.register_variable(Float64("v0", unit="m/s", **fixed))

    def exit_initialization_mode(self):
        self.speed = self.v0

    def do_step(self, current_time, step_size):
        up = self.grade + atan(0.01 * self.steepness)
        rate = (self.force - 100.0 * self.speed) / 1000.0 - 9.81 * sin(up)
        self.position += step_size * self.speed
        self.speed += step_size * rate
        return Fmi3StepResult(status=Fmi3Status.ok)
