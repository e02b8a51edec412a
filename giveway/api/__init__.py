"""The Python API: one call runs a simulation and returns its result."""

from giveway.api.running import Outputs, in_journal, keep, run, run_checked
from giveway.api.simulation import simulate
from giveway.results.run_result import RunResult

__all__ = ["Outputs", "RunResult", "in_journal", "keep", "run", "run_checked", "simulate"]
