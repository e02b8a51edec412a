"""The places where people can walk: routes, walkingareas, crossings, and their walls."""

from giveway.walkways.beside import SpawnPlace, beside
from giveway.walkways.network import NearestLane, WalkNetwork
from giveway.walkways.reading import PedLane, Signal
from giveway.walkways.route import WalkRoute

__all__ = [
    "NearestLane",
    "PedLane",
    "Signal",
    "SpawnPlace",
    "WalkNetwork",
    "WalkRoute",
    "beside",
]
