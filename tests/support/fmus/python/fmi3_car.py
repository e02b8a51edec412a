"""A car for PythonFMU3: FMI 3.0 with units; 'python -m pythonfmu3 build -f' packs it."""

from pythonfmu3 import (
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3Status,
    Fmi3StepResult,
    Fmi3Variability,
)
from pythonfmu3.unit import Unit


class PythonCar3(Fmi3Slave):
    """M v' + alpha v = force, one explicit Euler step per communication step; speaks km/h."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        self.force = 0.0
        self.mass = 1000.0
        self.friction = 100.0
        self.v0 = 0.0
        self.speed = 0.0
        self.position = 0.0
        self.register_units(
            [
                Unit("kN", factor=1000.0, kg=1, m=1, s=-2),
                Unit("km/h", factor=1 / 3.6, m=1, s=-1),
                Unit("m", m=1),
                Unit("kg", kg=1),
                Unit("N.s/m", kg=1, s=-1),
            ]
        )
        independent = {
            "causality": Fmi3Causality.independent,
            "variability": Fmi3Variability.continuous,
        }
        self.register_variable(Float64("time", **independent))
        changing = {"variability": Fmi3Variability.continuous}
        self.register_variable(
            Float64("force", causality=Fmi3Causality.input, unit="kN", start=0.0, **changing)
        )
        self.register_variable(
            Float64("speed", causality=Fmi3Causality.output, unit="km/h", **changing)
        )
        self.register_variable(
            Float64("position", causality=Fmi3Causality.output, unit="m", **changing)
        )
        fixed = {"causality": Fmi3Causality.parameter, "variability": Fmi3Variability.fixed}
        self.register_variable(Float64("mass", unit="kg", **fixed))
        self.register_variable(Float64("friction", unit="N.s/m", **fixed))
        self.register_variable(Float64("v0", unit="km/h", **fixed))

    def exit_initialization_mode(self):
        self.speed = self.v0

    def do_step(self, current_time, step_size):
        speed = self.speed / 3.6
        rate = (1000.0 * self.force - self.friction * speed) / self.mass
        self.position += step_size * speed
        self.speed = 3.6 * (speed + step_size * rate)
        return Fmi3StepResult(status=Fmi3Status.ok)
