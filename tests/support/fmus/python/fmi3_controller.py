"""A controller for PythonFMU3: FMI 3.0 in km/h, told how far off people will be in three steps."""

from pythonfmu3 import (
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3Status,
    Fmi3StepResult,
    Fmi3Variability,
)
from pythonfmu3.unit import Unit


class AheadController(Fmi3Slave):
    """Answers a speed: that which leaves 3 s to the nearest of three predicted gaps."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        self.speed, self.last = 0.0, 0.0
        self.ahead1 = self.ahead2 = self.ahead3 = 0.0
        self.wanted = 0.0
        self.cruise = 0.0
        self.register_units(
            [
                Unit("kN", factor=1000.0, kg=1, m=1, s=-2),
                Unit("km/h", factor=1 / 3.6, m=1, s=-1),
                Unit("m", m=1),
            ]
        )
        clock = {
            "causality": Fmi3Causality.independent,
            "variability": Fmi3Variability.continuous,
        }
        self.register_variable(Float64("time", **clock))
        told = {"causality": Fmi3Causality.input, "variability": Fmi3Variability.continuous}
        self.register_variable(Float64("speed", unit="km/h", start=0.0, **told))
        self.register_variable(Float64("last", unit="kN", start=0.0, **told))
        for name in ("ahead1", "ahead2", "ahead3"):
            self.register_variable(Float64(name, unit="m", start=0.0, **told))
        self.register_variable(
            Float64(
                "wanted",
                unit="km/h",
                causality=Fmi3Causality.output,
                variability=Fmi3Variability.continuous,
            )
        )
        self.register_variable(
            Float64(
                "cruise",
                unit="km/h",
                causality=Fmi3Causality.parameter,
                variability=Fmi3Variability.fixed,
            )
        )

    def do_step(self, current_time, step_size):
        nearest = min(self.ahead1, self.ahead2, self.ahead3)
        self.wanted = min(self.cruise, 3.6 * max(0.0, nearest - 2.0) / 3.0)
        return Fmi3StepResult(status=Fmi3Status.ok)
