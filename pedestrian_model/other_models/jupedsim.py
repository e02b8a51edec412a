"""The pedestrian models of JuPedSim. This is the only file that imports JuPedSim.

JuPedSim does not allow to set an agent's position, and has neither vehicles nor external forces.
Therefore a new simulation is made in each step, on open ground around the pedestrians, with their
positions and velocities. Each agent is steered straight to its goal. The new positions are the
answer. This works for models whose state is position and velocity (:data:`JUPEDSIM_MODELS`), but
not for models that remember more.

Giveway adds what JuPedSim lacks. People stop before the strip of a moving vehicle as in
``gap-acceptance``, by a lower desired speed. A vehicle's body is a row of circles: agents that are
too heavy to be moved. Towards a wall speeds are limited so that people stop before it.
"""

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

_STEP = 0.01  # longest step [s] of force-based models, JuPedSim's own
_ROOM = 15.0  # margin [m] of the ground around the pedestrians; JuPedSim looks 4 m far
_TO = 5.0  # distance [m] of an agent's target ahead
_POINT = 1e-9  # radius [m] of a new agent; its true radius is set when all are placed
_ASIDE = 1e-3  # distance [m] by which an agent is moved if another one has the same place
_GOLDEN = 2.399963229728653  # golden angle [rad] between the directions of two such moves (_ASIDE)
_HEAVY = 1e9  # mass [kg] of a vehicle's circles
_FASTEST = 10.0  # largest desired speed [m/s] that JuPedSim accepts
_THROWN = 10.0  # speed [m/s] of people in a vehicle's body, above which a step ends early


class JuPedSimPeople:
    """One of JuPedSim's models, in the form of a plug-in.

    Args:
        name: Name of the model.
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
        """Return the velocities of all pedestrians after the step from t_k to t_k+1."""
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
            if np.abs(velocity).max() > _THROWN:  # friction deep in a body accelerates without end
                break
        return Velocities(self._limited(velocity, walkers))

    def _people(
        self, simulation: Any, walkers: Walkers, steered: dict[str, Any]
    ) -> tuple[list[int], Array]:
        """Add all pedestrians as agents; return their ids and their positions (n, 2) [m]."""
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
        """Add the circles of vehicles as agents that drive on."""
        for k, (x, y, radius, v_x, v_y) in enumerate(bodies):
            speed = math.hypot(v_x, v_y)
            own = {"velocity": (v_x, v_y), "mass": _HEAVY} if self._forces else {}
            own |= steered | {"desired_speed": min(speed, _FASTEST)}
            agent = self._placed(simulation, np.array([x, y]), k, own)
            agent.model.radius = radius
            to = _TO / max(speed, _POINT)
            agent.target = (x + to * v_x, y + to * v_y)

    def _placed(self, simulation: Any, place: Array, number: int, settings: dict[str, Any]) -> Any:
        """Add an agent, moved by a millimetre or more if the place is occupied, and return it.

        The result is valid until the next agent is added, because JuPedSim moves agents in memory.
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
        """Limit velocities to the largest speed of people, and so that they stop at walls."""
        normal = walkers.walls.normal
        least = (self._radius - walkers.walls.distance) / RELAXATION
        towards = (velocity * normal).sum(axis=1)
        near = np.isfinite(walkers.walls.distance)
        velocity = (
            velocity + np.where(near, np.maximum(least - towards, 0.0), 0.0)[:, None] * normal
        )
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        limited: Array = velocity * (self._fastest / np.maximum(speed, self._fastest))[:, None]
        return limited


def _circles(vehicles: Array) -> Array:
    """Return circles (k, 5) that cover vehicles (m, 7): x, y, radius [m], velocity x, y [m/s]."""
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
    """Lower each ``pace`` (n,) [m/s] so that people stop before the strips of vehicles.

    Args:
        position: Positions (n, 2) [m].
        ahead: Unit vectors (n, 2) to the goals.
        pace: Desired speeds (n,) [m/s], changed.
        vehicles: Vehicles (m, 7).
        radius: Radius of a body [m].
    """
    for i in range(len(pace)):
        place, direction = (position[i, 0], position[i, 1]), (ahead[i, 0], ahead[i, 1])
        slowest = speed_before(place, direction, pace[i], vehicles, radius, 0.0)
        pace[i] = min(pace[i], slowest)
