"""People who walk by a model of JuPedSim's; the only file that imports it, when one is made.

JuPedSim lets nobody set an agent's position, and knows neither vehicles nor forces of others. So a
simulation is built anew in each step, on open ground round those who walk, with everybody where and
as fast as they are, steered straight to where they want to go; where it has moved them is the
answer. That serves models whose state is position and velocity (:data:`JUPEDSIM_MODELS`), and none
that remembers more.

What JuPedSim does not know is ours: before the strip of a moving vehicle people stop as in
``gap-acceptance``, by the speed that they want; its body is a row of circles, agents like others,
too heavy to be moved; and towards a wall nobody is faster than what stops there.
"""

from __future__ import annotations

import math
from typing import Any, Final, Literal, get_args

import numpy as np

from pedestrian_model._jit import kernel
from pedestrian_model.arrays import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y
from pedestrian_model.errors import PlugInError
from pedestrian_model.other_models.simple import speed_before
from pedestrian_model.other_models.social_force import RELAXATION
from pedestrian_model.plug_in import Array, ModelSetup, Velocities, Walkers

JuPedSimName = Literal["jupedsim:CollisionFreeSpeedModel", "jupedsim:SocialForceModel"]
JUPEDSIM_MODELS: Final[tuple[JuPedSimName, ...]] = get_args(JuPedSimName)
"""Tordeux, Chraibi and Seyfried (arXiv 1512.05597); Helbing, Farkas and Vicsek (Nature 2000)."""

_STEP = 0.01  # [s] of the forces at most, JuPedSim's own; speeds are set once in a step
_ROOM = 15.0  # [m] of ground beyond the outermost; JuPedSim looks 4 m far
_TO = 5.0  # [m] the target lies ahead, on that ground
_POINT = 1e-9  # [m] nobody may be placed within another's radius: it is given afterwards
_ASIDE = 1e-3  # [m] that somebody is moved who stands where another one does
_GOLDEN = 2.399963229728653  # [rad] from one direction to the next
_HEAVY = 1e9  # [kg]
_FASTEST = 10.0  # [m/s] that JuPedSim lets an agent want; where it is says more
_THROWN = 10.0  # [m/s] of who overlaps with a body: where that leads to, no step of 0.01 s follows


class JuPedSimPeople:
    """One of JuPedSim's models, as somebody else's are asked.

    Args:
        name: which one.
        setup: Setup of the run.

    Raises:
        ImportError: JuPedSim is not installed.
    """

    def __init__(self, name: JuPedSimName, setup: ModelSetup) -> None:
        import jupedsim

        self._jupedsim: Any = jupedsim
        kind = name.partition(":")[2]
        self._model = getattr(jupedsim, kind)()
        self._agent = getattr(jupedsim, f"{kind}AgentParameters")
        self._forces = kind == "SocialForceModel"
        self._radius, self._fastest = setup.body_radius, setup.max_speed
        self._step = setup.time_step
        self._times = max(1, math.ceil(setup.time_step / _STEP - 1e-9)) if self._forces else 1

    def step(self, walkers: Walkers) -> Velocities:
        """Move everybody from t_k to t_k+1."""
        low, high = walkers.position.min(axis=0) - _ROOM, walkers.position.max(axis=0) + _ROOM
        simulation = self._jupedsim.Simulation(
            model=self._model,
            geometry=[tuple(low), (high[0], low[1]), tuple(high), (low[0], high[1])],
            dt=self._step / self._times,
        )
        stage = simulation.add_direct_steering_stage()
        journey = simulation.add_journey(self._jupedsim.JourneyDescription([stage]))
        steered = {"journey_id": journey, "stage_id": stage}
        ids, began = self._people(simulation, walkers, steered)
        bodies = _circles(walkers.vehicles)
        near = (bodies[:, :2] > low + _TO) & (bodies[:, :2] < high - _TO)
        self._bodies(simulation, bodies[near.all(axis=1)], steered)
        for _ in range(self._times):
            simulation.iterate()
            if self._forces:
                velocity = np.array([simulation.agent(i).model.velocity for i in ids])
            else:
                places = np.array([simulation.agent(i).position for i in ids])
                velocity = (places - began) / self._step
            if np.abs(velocity).max() > _THROWN:  # by friction deep in a body: ever faster
                break
        return Velocities(self._limited(velocity, walkers))

    def _people(
        self, simulation: Any, walkers: Walkers, steered: dict[str, Any]
    ) -> tuple[list[int], Array]:
        """Everybody as an agent: their ids, and (n, 2) [m] where they are."""
        pace = np.hypot(walkers.preferred[:, 0], walkers.preferred[:, 1])
        ahead = walkers.preferred / np.maximum(pace, _POINT)[:, None]
        _stop_before(walkers.position, ahead, pace, walkers.vehicles, self._radius)
        ids, began = [0] * len(pace), np.empty((len(pace), 2))
        for i in np.argsort(walkers.ids, kind="stable"):
            place = walkers.position[i]
            own = {"velocity": tuple(walkers.velocity[i])} if self._forces else {}
            own |= steered | {"desired_speed": float(pace[i])}
            agent = self._placed(simulation, place, int(walkers.ids[i]), own)
            agent.model.radius = self._radius
            agent.target = tuple(place + _TO * ahead[i])
            ids[i], began[i] = agent.id, agent.position
        return ids, began

    def _bodies(self, simulation: Any, bodies: Array, steered: dict[str, Any]) -> None:
        """The vehicles' circles as agents that drive on."""
        for k, (x, y, radius, v_x, v_y) in enumerate(bodies):
            speed = math.hypot(v_x, v_y)
            own = {"velocity": (v_x, v_y), "mass": _HEAVY} if self._forces else {}
            own |= steered | {"desired_speed": min(speed, _FASTEST)}
            agent = self._placed(simulation, np.array([x, y]), k, own)
            agent.model.radius = radius
            to = _TO / max(speed, _POINT)
            agent.target = (x + to * v_x, y + to * v_y)

    def _placed(self, simulation: Any, place: Array, number: int, settings: dict[str, Any]) -> Any:
        """A new agent, a millimetre aside if somebody is there already.

        What is returned is good until the next one is added: JuPedSim moves its agents in memory.
        """
        x, y = float(place[0]), float(place[1])
        parameters = self._agent(position=(x, y), radius=_POINT, **settings)
        for turn in range(1, 100):
            try:
                return simulation.agent(simulation.add_agent(parameters))
            except RuntimeError as error:
                if "too close" not in str(error):
                    raise
            angle = _GOLDEN * (number + turn)
            aside = turn * _ASIDE
            parameters.position = (x + aside * math.cos(angle), y + aside * math.sin(angle))
        raise PlugInError(f"a hundred people stand at {x:g}, {y:g} m")

    def _limited(self, velocity: Array, walkers: Walkers) -> Array:
        """Limit speeds to those of people, and to those that can stop at a wall."""
        normal = walkers.wall_normal
        least = (self._radius - walkers.wall_distance) / RELAXATION
        towards = (velocity * normal).sum(axis=1)
        near = np.isfinite(walkers.wall_distance)
        velocity = (
            velocity + np.where(near, np.maximum(least - towards, 0.0), 0.0)[:, None] * normal
        )
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        limited: Array = velocity * (self._fastest / np.maximum(speed, self._fastest))[:, None]
        return limited


def _circles(vehicles: Array) -> Array:
    """(k, 5) x, y, radius [m], velocity [m/s] of circles that cover vehicles (m, 7)."""
    circles = [np.empty((0, 5))]
    for vehicle in vehicles:
        length, width = vehicle[FRONT] + vehicle[REAR], vehicle[WIDTH]
        count = max(1, math.ceil(2.0 * length / width))
        part = length / count
        way = np.array([math.cos(vehicle[HEADING]), math.sin(vehicle[HEADING])])
        ahead = (np.arange(count) + 0.5) * part - vehicle[REAR]
        row = np.empty((count, 5))
        row[:, :2] = vehicle[[X, Y]] + ahead[:, None] * way
        row[:, 2], row[:, 3:] = 0.5 * math.hypot(part, width), vehicle[SPEED] * way
        circles.append(row)
    return np.concatenate(circles)


@kernel
def _stop_before(
    position: Array, ahead: Array, pace: Array, vehicles: Array, radius: float
) -> None:
    """Lower each ``pace`` (n,) [m/s] to what stops before the strips of vehicles."""
    for i in range(len(pace)):
        place, direction = (position[i, 0], position[i, 1]), (ahead[i, 0], ahead[i, 1])
        slowest = speed_before(place, direction, pace[i], vehicles, radius, 0.0)
        pace[i] = min(pace[i], slowest)
