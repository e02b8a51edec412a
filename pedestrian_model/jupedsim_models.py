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
from numpy.typing import NDArray

from pedestrian_model._jit import kernel
from pedestrian_model._social_force import RELAXATION
from pedestrian_model._vehicles import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y
from pedestrian_model.errors import PlugInError
from pedestrian_model.plain_models import pace_before
from pedestrian_model.plug_in import Array, ModelSetup, Velocities, Walkers

JuPedSimName = Literal["jupedsim:CollisionFreeSpeedModel", "jupedsim:SocialForceModel"]
JUPEDSIM_MODELS: Final[tuple[JuPedSimName, ...]] = get_args(JuPedSimName)
"""Tordeux, Chraibi and Seyfried (arXiv 1512.05597); Helbing, Farkas and Vicsek (Nature 2000)."""

_STEP = 0.01  # [s] of the forces at most, JuPedSim's own; speeds are set once in a step
_ROOM = 10.0  # [m] of ground beyond the outermost: JuPedSim looks 4 m far
_TO = 5.0  # [m] the target lies ahead, on that ground
_POINT = 1e-9  # [m] nobody may be placed within another's radius: it is given afterwards
_ASIDE = 1e-3  # [m] that somebody is moved who stands where another one does
_GOLDEN = 2.399963229728653  # [rad] from one direction to the next
_HEAVY = 1e9  # [kg]
_THROWN = 10.0  # [m/s] of who overlaps with a body: where that leads to, no step of 0.01 s follows


class JuPedSimPeople:
    """One of JuPedSim's models, as somebody else's are asked.

    Args:
        name: which one.
        setup: of the run.

    Raises:
        PlugInError: JuPedSim is not installed.
    """

    def __init__(self, name: JuPedSimName, setup: ModelSetup) -> None:
        try:
            import jupedsim
        except ImportError as error:
            msg = f"model '{name}': JuPedSim is not installed; install it with: "
            raise PlugInError(msg + "pip install 'giveway[jupedsim]'") from error
        self._jupedsim: Any = jupedsim
        kind = name.partition(":")[2]
        self._model = getattr(jupedsim, kind)()
        self._agent = getattr(jupedsim, f"{kind}AgentParameters")
        self._forces = kind == "SocialForceModel"
        self._radius, self._fastest = setup.body_radius, setup.max_speed
        self._step = setup.time_step
        self._times = max(1, math.ceil(setup.time_step / _STEP - 1e-9)) if self._forces else 1

    def step(self, walkers: Walkers) -> Velocities:
        """How everybody moves from t_k to t_k+1."""
        n = len(walkers.ids)
        pace = np.hypot(walkers.preferred[:, 0], walkers.preferred[:, 1])
        ahead = walkers.preferred / np.maximum(pace, _POINT)[:, None]
        _stop_before(walkers.position, ahead, pace, walkers.vehicles, self._radius)
        bodies = np.concatenate([_circles(v) for v in walkers.vehicles] or [np.empty((0, 7))])
        places = np.concatenate([walkers.position, bodies[:, :2]])
        simulation = self._jupedsim.Simulation(
            model=self._model, geometry=_ground(places), dt=self._step / self._times
        )
        stage = simulation.add_direct_steering_stage()
        journey = simulation.add_journey(self._jupedsim.JourneyDescription([stage]))
        order = np.argsort(walkers.ids, kind="stable")
        ids, began = np.empty(n, dtype=np.int64), np.empty((n, 2))
        for i in order:
            own = {"velocity": tuple(walkers.velocity[i])} if self._forces else {}
            wish = {"desired_speed": float(pace[i]), "journey_id": journey, "stage_id": stage}
            agent = self._placed(simulation, walkers.position[i], int(walkers.ids[i]), own | wish)
            agent.model.radius = self._radius
            agent.target = tuple(walkers.position[i] + _TO * ahead[i])
            ids[i], began[i] = agent.id, agent.position
        for k, (x, y, radius, c, s, speed, _) in enumerate(bodies):
            own = {"velocity": (speed * c, speed * s), "mass": _HEAVY} if self._forces else {}
            wish = {"desired_speed": abs(speed), "journey_id": journey, "stage_id": stage}
            agent = self._placed(simulation, np.array([x, y]), k, own | wish)
            agent.model.radius = radius
            agent.target = (x + math.copysign(_TO, speed) * c, y + math.copysign(_TO, speed) * s)
        if not self._forces:
            simulation.iterate()
            places = np.array([simulation.agent(i).position for i in ids])
            return Velocities(self._limited((places - began) / self._step, walkers))
        for _ in range(self._times):
            simulation.iterate()
            velocity = np.array([simulation.agent(i).model.velocity for i in ids])
            if np.abs(velocity).max() > _THROWN:  # by friction deep in a body: ever faster
                break
        return Velocities(self._limited(velocity, walkers))

    def _placed(self, simulation: Any, place: Array, number: int, settings: dict[str, Any]) -> Any:
        """A new agent, a millimetre aside if somebody is there already."""
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
        """As fast as people are, and slow enough to stop at a wall."""
        normal = walkers.wall_normal
        least = (self._radius - walkers.wall_distance) / RELAXATION
        towards = (velocity * normal).sum(axis=1)
        near = np.isfinite(walkers.wall_distance)
        velocity = velocity + np.where(near, np.maximum(least - towards, 0.0), 0.0)[:, None] * normal
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        limited: Array = velocity * (self._fastest / np.maximum(speed, self._fastest))[:, None]
        return limited


def _circles(vehicle: Array) -> Array:
    """(k, 7) x, y, radius [m], direction, speed [m/s] of circles that cover a vehicle."""
    count = max(1, math.ceil((vehicle[FRONT] + vehicle[REAR]) / (0.5 * vehicle[WIDTH])))
    part = (vehicle[FRONT] + vehicle[REAR]) / count
    ahead = (np.arange(count) + 0.5) * part - vehicle[REAR]
    c, s = math.cos(vehicle[HEADING]), math.sin(vehicle[HEADING])
    circles = np.zeros((count, 7))
    circles[:, 0], circles[:, 1] = vehicle[X] + ahead * c, vehicle[Y] + ahead * s
    circles[:, 2] = 0.5 * math.hypot(part, vehicle[WIDTH])
    circles[:, 3:6] = c, s, vehicle[SPEED]
    return circles


def _ground(places: Array) -> list[tuple[float, float]]:
    """A rectangle round all places [m]."""
    (x_0, y_0), (x_1, y_1) = places.min(axis=0) - _ROOM, places.max(axis=0) + _ROOM
    return [(x_0, y_0), (x_1, y_0), (x_1, y_1), (x_0, y_1)]


@kernel
def _stop_before(
    position: Array, ahead: Array, pace: Array, vehicles: Array, radius: float
) -> None:
    """Lower each ``pace`` (n,) [m/s] to what stops before the strips of vehicles."""
    for i in range(len(pace)):
        x, y, e_x, e_y = position[i, 0], position[i, 1], ahead[i, 0], ahead[i, 1]
        slowest = pace_before(x, y, e_x, e_y, pace[i], vehicles, radius, 0.0)
        pace[i] = min(pace[i], slowest)
