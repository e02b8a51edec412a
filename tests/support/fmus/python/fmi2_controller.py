"""A controller for PythonFMU (FMI 2.0, without units): a time headway, and what can go wrong."""

import os
import time

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real

NAN, RAISE, HANG, EXIT = 1, 2, 3, 4


class HeadwayController(Fmi2Slave):
    """Asks for the acceleration towards gap / headway, at most v_max."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.v, self.gap, self.limit = 0.0, 0.0, 0.0  # [m/s], [m], [m/s]
        self.a_set = 0.0  # [m/s2]
        self.headway, self.cruise, self.fault = 2.0, 4.0, 0
        for name in ("v", "gap", "limit"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("a_set", causality=Fmi2Causality.output))
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(Real("headway", **fixed))
        self.register_variable(Real("cruise", **fixed))
        self.register_variable(Integer("fault", **fixed))

    def do_step(self, current_time, step_size):
        wanted = min(self.cruise, self.limit, max(0.0, self.gap - 2.0) / self.headway)
        self.a_set = max(-5.0, min(1.5, (wanted - self.v) / 0.8))
        if current_time > 0.99:
            if self.fault == NAN:
                self.a_set = float("nan")
            elif self.fault == RAISE:
                raise RuntimeError("out of ideas")
            elif self.fault == HANG:
                time.sleep(600)
            elif self.fault == EXIT:
                os._exit(3)
        return True
