"""A car for PythonFMU (FMI 2.0, without units): 'python -m pythonfmu build -f' packs it."""

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class PythonCar(Fmi2Slave):
    """M v' + alpha v = force, one explicit Euler step per communication step."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.force = 0.0  # [N]
        self.mass = 1000.0  # [kg]
        self.friction = 100.0  # [N.s/m]
        self.v0 = 0.0  # [m/s]
        self.speed = 0.0
        self.position = 0.0
        self.broken = False
        self.register_variable(Real("force", causality=Fmi2Causality.input))
        self.register_variable(Real("speed", causality=Fmi2Causality.output))
        self.register_variable(Real("position", causality=Fmi2Causality.output))
        for name in ("mass", "friction", "v0"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
            )
        self.register_variable(
            Boolean("broken", causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
        )

    def exit_initialization_mode(self):
        self.speed = self.v0

    def do_step(self, current_time, step_size):
        if self.broken and current_time > 0.19:
            raise RuntimeError("the gearbox is missing")
        rate = (self.force - self.friction * self.speed) / self.mass
        self.position += step_size * self.speed
        self.speed += step_size * rate
        return True
