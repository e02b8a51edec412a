"""The safety layer of one ego on its way."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from controller import LongitudinalModel, SafetyLayer, SafetyParameters
from giveway.ego.way_ahead import WayAhead

if TYPE_CHECKING:
    from controller import Decision
    from giveway.config import EgoRunConfig
    from giveway.geometry.bodies import VehicleShape
    from giveway.geometry.path import EgoPath
    from pedestrian_model import Crowd


class Guard:
    """Watches over one ego's forces.

    Args:
        limits: of people and of the brake.
        config: of the ego.
        path: its way.
        shape: its body.
        time_step: of the co-simulation [s].
    """

    def __init__(
        self,
        limits: SafetyParameters,
        config: EgoRunConfig,
        path: EgoPath,
        shape: VehicleShape,
        time_step: float,
    ) -> None:
        model = LongitudinalModel(config.vehicle.mass, config.vehicle.friction, time_step)
        self._layer = SafetyLayer(model, replace(limits, width=shape.width))
        self._way = WayAhead(path, shape.length)

    def overrule(
        self, decision: Decision, front: float, speed: float, crowd: Crowd
    ) -> Decision | None:
        """The safety layer's decision instead of the controller's; None: it lets that through.

        Args:
            decision: the controller's.
            front: the front bumper's station [m].
            speed: the ego's [m/s].
            crowd: the pedestrians as it sees them.
        """
        way, spacing = self._way.sample(front, self._layer.reach(speed))
        safe = self._layer.filter(
            decision.force, speed, way, spacing, crowd.position, crowd.velocity
        )
        if not safe.acted:
            return None
        return decision._replace(force=safe.force, acting="safety", reason=safe.reason)
