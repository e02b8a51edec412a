"""The world as it is at a control step, which the egos' sensors are shown."""

from collections.abc import Iterable, Sequence

from giveway.cosimulation.assembly import Parts
from giveway.cosimulation.mirror import Mirror
from giveway.ego.ego import Ego
from giveway.ego.perception.truth import Truth
from giveway.ego.perception.visibility import CHILD
from giveway.geometry.kernel import Array
from giveway.run_data.scene import Opaque
from giveway.sumo.opaque_bodies import OpaqueBodies


class World:
    """Fills in the truth at each control step.

    Heights and walls are read only if an ego has a sensor that may need them.

    Args:
        parts: Parts of the run.
        mirror: Source of the vehicles' poses.
    """

    def __init__(self, parts: Parts, mirror: Mirror) -> None:
        self._roster, self._mirror = parts.roster, mirror
        self._truth = Truth.of_people(parts.roster.crowd)
        looked_at = any(ego.config.perception.plugged_in_sensor for ego in parts.egos)
        self._cameras = any(ego.config.perception.sensor == "sight" for ego in parts.egos)
        self._opaque = parts.sumo.opaque if looked_at else None
        if self._opaque is not None:
            self._truth.outlines = self._opaque.walls(parts.config.perception.heights)

    def at(self, time: float, egos: Sequence[Ego]) -> Truth:
        """Return the truth at an instant; the next call overwrites it.

        Args:
            time: SUMO's clock [s].
            egos: Egos on the road, in the order of their rows.
        """
        truth, opaque, mirror = self._truth, self._opaque, self._mirror
        truth.people, truth.vehicles, truth.time = self._roster.crowd, mirror.poses[0], time
        if opaque is not None:
            vehicles = [ego.id for ego in egos] + mirror.background_ids
            truth.vehicle_heights = opaque.vehicle_heights(vehicles)
            truth.person_heights = self._person_heights(opaque)
        return truth

    def opaque(self, names: Iterable[str]) -> Opaque | None:
        """The walls, and the heights of vehicles that have been on the road; None without cameras.

        Args:
            names: Ids of the vehicles.
        """
        if self._opaque is None or not self._cameras:
            return None
        known = sorted(map(str, set(names)))
        heights = self._opaque.vehicle_heights(known).tolist()
        return Opaque(self._truth.outlines, dict(zip(known, heights, strict=True)))

    def _person_heights(self, opaque: OpaqueBodies) -> Array:
        """The heights (n,) [m] of the people: SUMO's, but children's of giveway's own."""
        traits, names = self._roster.traits, self._roster.names
        heights = opaque.person_heights(names)
        if traits:
            kinds = [name in traits and traits[name].kind == "child" for name in names]
            heights[kinds] = CHILD
        return heights
