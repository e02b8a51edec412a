"""A package with a controller that keeps to the rules, and one with a controller that does not."""

from __future__ import annotations

import tomllib

import pytest
from support.plug_ins import printed

FAULTY = """
import os, time
import numpy as np
from dataclasses import dataclass
from controller import Acceleration

@dataclass
class Fault:
    kind: str = "none"

class Driver:
    Options = Fault
    def __init__(self, setup, options):
        self.kind, self.asked = options.kind, 0
        if self.kind == "step":
            raise ValueError(f"steps of {setup.time_step} s")
    def control(self, seen):
        self.asked += 1
        if self.asked <= 20:
            return Acceleration(0.1)
        if self.kind == "nan":
            return Acceleration(np.nan)
        if self.kind == "shape":
            return np.zeros(3)
        if self.kind == "raise":
            raise ValueError("no idea")
        if self.kind == "leave":
            raise SystemExit(0)
        if self.kind == "exit":
            os._exit(0)
        if self.kind == "hang":
            time.sleep(600)
        return Acceleration(0.1)
"""


@pytest.fixture
def careful(installed):
    """The package of the page."""
    points = tomllib.loads(printed("file: pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points["giveway.controllers"].items()
    return installed(
        "careful_driver", printed("file: careful_driver.py"), declares=f"{name} = {value}"
    )


@pytest.fixture
def faulty(installed):
    return installed("faulty_driver", FAULTY, declares="broken = faulty_driver:Driver")
