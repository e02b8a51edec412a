"""Compiled parts of the VCI prediction that giveway builds into kernels of its own."""

from pedestrian_model._jit import borrowed
from pedestrian_model.vci.prediction import desired_velocity
from pedestrian_model.vci.rollout import rollout_step, start

__all__ = ["borrowed", "desired_velocity", "rollout_step", "start"]
