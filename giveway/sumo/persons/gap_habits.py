"""Reads how persons of SUMO accept gaps where vehicles have priority, as the scenario says it.

SUMO 1.28 reads it from ``--pedestrian.timegap-crossing``, which a parameter of a person or a type
overrides, and from the type's attributes ``jmTimegapMinor``, ``impatience``, ``jmIgnoreFoeProb``
and ``jmIgnoreFoeSpeed``.
"""

from typing import Any, NamedTuple

_TIMEGAP = "pedestrian.timegap-crossing"
_JUNCTION = "junctionModel."
_TIMEGAP_MINOR = 1.0  # SUMO's default [s] of jmTimegapMinor


class GapHabit(NamedTuple):
    """The habit by which a person accepts gaps."""

    margin: float  # time [s] between the end of the crossing and the arrival of a vehicle
    impatience: float  # impatience without waiting; the person trusts vehicles to brake at 1
    ignore_probability: float  # probability of ignoring a slow vehicle, at each of SUMO's steps
    ignore_speed: float  # speed [m/s] up to which vehicles are ignored
    waited: float  # time [s] for which the person has stood already


class GapHabits:
    """Reads how persons accept gaps.

    Args:
        sumo: The libsumo module, with a simulation running.
    """

    def __init__(self, sumo: Any) -> None:
        self._sumo = sumo
        self._of_types: dict[str, GapHabit] = {}

    def of(self, person: str, kind: str) -> GapHabit:
        """Return the habit of a person.

        Args:
            person: Id of the person.
            kind: Id of its type.
        """
        if kind not in self._of_types:
            self._of_types[kind] = self._of_type(kind)
        habit, persons = self._of_types[kind], self._sumo.person
        own = persons.getParameter(person, _TIMEGAP)
        if own:
            habit = habit._replace(margin=float(own) + self._junction(kind, "jmTimegapMinor"))
        return habit._replace(waited=float(persons.getWaitingTime(person)))

    def _of_type(self, kind: str) -> GapHabit:
        types, option = self._sumo.vehicletype, self._sumo.simulation.getOption
        timegap = float(types.getParameter(kind, _TIMEGAP) or option(_TIMEGAP))
        return GapHabit(
            timegap + self._junction(kind, "jmTimegapMinor"),
            float(types.getImpatience(kind)),
            self._junction(kind, "jmIgnoreFoeProb"),
            self._junction(kind, "jmIgnoreFoeSpeed"),
            0.0,
        )

    def _junction(self, kind: str, name: str) -> float:
        """Return an attribute of a type, or SUMO's default."""
        text = self._sumo.vehicletype.getParameter(kind, _JUNCTION + name)
        return float(text or (_TIMEGAP_MINOR if name == "jmTimegapMinor" else 0.0))
