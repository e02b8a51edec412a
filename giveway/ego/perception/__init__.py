"""Perception of an ego: sensors, and the people and vehicles in front on its path.

Packages with a sensor of their own import these names from here.
"""

from giveway.ego.perception.protocol import Ids, OwnState, Percept, Sensor, SensorSetup
from giveway.ego.perception.truth import Truth

__all__ = ["Ids", "OwnState", "Percept", "Sensor", "SensorSetup", "Truth"]
