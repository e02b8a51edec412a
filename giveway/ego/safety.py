"""The safety layer of one ego on its path."""

from dataclasses import replace

import numpy as np

from controller import Decision, LongitudinalModel, SafetyLayer, SafetyParameters
from giveway.config import EgoRunConfig
from giveway.ego.kerbs import NO_KERBS
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array, kernel
from giveway.geometry.path import EgoPath, body_pose, segment_at
from pedestrian_model import Crowd

_FINEST = 0.25  # [m] between poses: a chord of a bend of 5 m radius is 1.6 mm off
_MOST = 256  # poses


class Guard:
    """Watches over one ego's forces.

    Args:
        limits: of pedestrians and of the brake.
        config: of the ego.
        path: of the ego.
        shape: of its body.
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
        self._poses = FrontPoses(path, shape.length)

    def overrule(
        self,
        decision: Decision,
        front: float,
        speed: float,
        crowd: Crowd,
        errors: Array | None = None,
        kerbs: Array = NO_KERBS,
    ) -> Decision | None:
        """The safety layer's decision instead of the controller's; None: it lets that through.

        Args:
            decision: the controller's.
            front: the front bumper's station [m].
            speed: the ego's [m/s].
            crowd: the pedestrians as it sees them.
            errors: (n,) [m] that their positions are off at most; None: as the limits say.
            kerbs: (n, 3) of those on sidewalks, see :meth:`giveway.ego.kerbs.Kerbs.of`.
        """
        poses, spacing = self._poses.sample(front, self._layer.reach(speed))
        safe = self._layer.filter(
            decision.force, speed, poses, spacing, crowd.position, crowd.velocity, errors, kerbs
        )
        if not safe.acted:
            return None
        return decision._replace(force=safe.force, acting="safety", reason=safe.reason)


class FrontPoses:
    """The poses of a body's front along a path; the array is handed out again and again.

    Args:
        path: of the front's middle, and of the rear's.
        length: of the body [m].
    """

    def __init__(self, path: EgoPath, length: float) -> None:
        self.path = path
        self.length = length
        self._buffer = np.zeros((_MOST, 4))

    def sample(self, front: float, reach: float) -> tuple[Array, float]:
        """The poses (k, 4) x, y [m], cos, sin from the station ``front`` on, and their spacing [m].

        Where the path is straight, from the rear bumper to ``reach`` [m] ahead of the front, one
        pose says everything.
        """
        spacing = max(_FINEST, reach / (_MOST - 2))
        path = self.path
        count = fill_front_poses(
            path.vertices,
            path.stations,
            path.headings,
            front,
            self.length,
            reach,
            spacing,
            self._buffer,
        )
        return self._buffer[:count], spacing


@kernel
def fill_front_poses(
    vertices: Array,
    stations: Array,
    headings: Array,
    front: float,
    length: float,
    reach: float,
    spacing: float,
    poses: Array,
) -> int:
    """Fill ``poses`` with x, y, cos, sin at front, front + spacing, ...; how many there are."""
    straight = segment_at(stations, front - length) == segment_at(stations, front + reach)
    count = 1 if straight else min(2 + int(reach / spacing), poses.shape[0])
    for i in range(count):
        x, y, heading = body_pose(vertices, stations, headings, front + i * spacing, length)
        poses[i, 0], poses[i, 1] = x, y
        poses[i, 2], poses[i, 3] = np.cos(heading), np.sin(heading)
    return count
