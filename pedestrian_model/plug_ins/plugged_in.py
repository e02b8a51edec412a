"""Somebody else's model of people among ours: shown who walks, its answer checked and limited."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import kernel
from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import PlugInError
from pedestrian_model.parameters import VciParameters
from pedestrian_model.plug_ins.plug_in import (
    Accelerations,
    Array,
    ModelPlugIn,
    ModelSetup,
    Velocities,
    Walkers,
)
from pedestrian_model.routes import heading_for
from pedestrian_model.stepping import FINE, divergence, first_insane, unknown_signal
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vehicles import Vehicles

_SHOWN = 80  # characters of what it returned
_ARRIVES = 0.3  # [m] about a way-point at which somebody slows down to stop
_NO_WALLS = np.empty((0, 4))
_NO_WALLS.flags.writeable = False
_Entry = TypeVar("_Entry", bound=np.generic)
_first_insane = kernel(first_insane)


class PluggedInModel:
    """A model of somebody else's as the co-simulation asks any other.

    Way-points, lines and signals are ours to follow; what people answer to each other, to walls and
    vehicles is the model's. Nobody gets more than the largest acceleration and speed of the
    parameters, which the safety layer's promise is about.

    Args:
        name: Name of the model, for messages.
        make: makes the plug-in.
        setup: Setup of the run.
        parameters: bodies and limits.
        who: the ids of those in the crowd; None: they are numbered as they stand in it.

    Raises:
        PlugInError: it cannot be made, or is no model.
    """

    def __init__(
        self,
        name: str,
        make: Callable[[], object],
        setup: ModelSetup,
        parameters: VciParameters,
        who: Callable[[], NDArray[np.int64]] | None = None,
    ) -> None:
        self.name, self.parameters, self.time_step = name, parameters, setup.time_step
        self._who = who
        with self._blamed("when it was made"):
            plug_in = make()
        if not isinstance(plug_in, ModelPlugIn):
            msg = f"{name} made {_shown(plug_in)}: expected an object with a method step"
            raise PlugInError(msg)
        self._plug_in = plug_in

    def reset(self) -> None:
        """Forget the past."""
        reset = getattr(self._plug_in, "reset", None)
        if reset is not None:
            with self._blamed("in reset"):
                reset()

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Change position, velocity and waypoint_index of ``crowd`` in place, one time step on.

        Raises:
            DivergenceError: if a pedestrian's state is not finite.
            PlugInError: the model raises, or answers no finite numbers, one pair for each.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if crowd.signals > surroundings.closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        if not len(crowd):
            return
        bad = _first_insane(crowd.position, crowd.velocity)
        if bad != FINE:
            raise divergence(bad, crowd, vehicles)
        walkers = self._seen(crowd, vehicles, surroundings)
        try:
            answer = self._plug_in.step(walkers)
        except (Exception, SystemExit) as error:
            raise self._blame(error, "") from error
        self._move(crowd, self._velocities(answer, crowd))

    def _seen(self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings) -> Walkers:
        """Return what the model is told; who has passed a way-point goes on to the next."""
        n, p = len(crowd), self.parameters
        preferred, goal, stops = np.empty((n, 2)), np.empty((n, 2)), np.empty(n, dtype=np.bool_)
        _head(
            crowd.state,
            crowd.desired_speed,
            crowd.routes,
            surroundings.closed,
            (p.waypoint_radius, p.body_radius),
            (preferred, goal, stops),
        )
        walls = surroundings.walls
        if walls is None:
            distance, normal, segments = np.full(n, np.inf), np.zeros((n, 2)), _NO_WALLS
        else:
            distance, normal = walls.nearest(crowd.position)
            segments = walls.segments
        ids = np.arange(n) if self._who is None else self._who()
        return Walkers(
            position=_fixed(crowd.position),
            velocity=_fixed(crowd.velocity),
            desired_speed=_fixed(crowd.desired_speed),
            preferred=_fixed(preferred),
            goal=_fixed(goal),
            stops=_fixed(stops),
            ids=_fixed(ids),
            vehicles=_fixed(vehicles.array),
            wall_distance=_fixed(distance),
            wall_normal=_fixed(normal),
            walls=_fixed(segments),
        )

    def _velocities(self, answer: object, crowd: Crowd) -> Array:
        """Return the velocities at the end of the step, within the limits, (n, 2) [m/s]."""
        before, h = crowd.velocity, self.time_step
        if isinstance(answer, Velocities):
            change = self._numbers(answer, answer.values, len(crowd), "m/s") - before
        else:
            values = answer.values if isinstance(answer, Accelerations) else answer
            change = h * self._numbers(answer, values, len(crowd), "m/s^2")
        after: Array = before + change * _within(change, h * self.parameters.max_acceleration)
        after *= _within(after, self.parameters.max_speed)
        return after

    def _move(self, crowd: Crowd, velocity: Array) -> None:
        crowd.position[:] += 0.5 * self.time_step * (crowd.velocity + velocity)
        crowd.velocity[:] = velocity

    def _numbers(self, answer: object, values: object, n: int, unit: str) -> Array:
        try:
            array = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.empty(0)
        if array.shape != (n, 2):
            raise PlugInError(
                f"{self.name} returned {_shown(answer)}: expected Accelerations or Velocities of "
                f"({n}, 2) numbers [{unit}], a pair for each pedestrian"
            )
        finite = np.isfinite(array).all(axis=1)
        if not finite.all():
            i = int(np.argmin(finite))
            msg = f"{self.name} returned {array[i].tolist()}: expected finite numbers [{unit}]"
            raise PlugInError(msg, i)
        return array

    @contextmanager
    def _blamed(self, when: str) -> Iterator[None]:
        try:
            yield
        except (Exception, SystemExit) as error:
            raise self._blame(error, f" {when}") from error

    def _blame(self, error: BaseException, when: str) -> PlugInError:
        return PlugInError(f"{self.name} raised {described(error)}{when}")


@kernel
def _head(
    state: tuple[Any, ...],
    desired_speed: Array,
    routes: tuple[Any, ...],
    closed: NDArray[np.bool_],
    radii: tuple[float, float],
    out: tuple[Any, ...],
) -> None:
    """Pass the way-points reached; where everybody walks to, and how fast they would like to."""
    position, _, waypoint_index = state
    preferred, goal, stops = out
    start = routes[3]
    for i in range(position.shape[0]):
        x, y = position[i, 0], position[i, 1]
        at, halts, to_x, to_y = heading_for(
            x,
            y,
            start[i] + waypoint_index[i],
            start[i + 1] - 1,
            routes,
            closed,
            radii,
        )
        waypoint_index[i] = at - start[i]
        goal[i, 0], goal[i, 1], stops[i] = to_x, to_y, halts
        e_x, e_y = to_x - x, to_y - y
        left = np.sqrt(e_x * e_x + e_y * e_y)
        slowed = np.sqrt(left * left + _ARRIVES * _ARRIVES) if halts else max(left, 1e-9)
        share = desired_speed[i] / slowed
        preferred[i, 0], preferred[i, 1] = share * e_x, share * e_y


def described(error: BaseException) -> str:
    """Kind, first line and place of an error of somebody else's: "ValueError: bad (a.py:3)"."""
    try:
        said = str(error).partition("\n")[0][: 3 * _SHOWN].strip()
    except Exception:
        said = ""
    frames = traceback.extract_tb(error.__traceback__)
    place = f" ({Path(frames[-1].filename).name}:{frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}{said and f': {said}'}{place}"


def _within(vectors: Array, longest: float) -> Array:
    """(n, 1) factors that shorten each vector (n, 2) to ``longest``; 1 for the shorter ones."""
    length = np.sqrt((vectors**2).sum(axis=1))[:, None]
    return np.asarray(longest / np.maximum(length, longest))


def _fixed(array: NDArray[_Entry]) -> NDArray[_Entry]:
    view = array.view()
    view.flags.writeable = False
    return view


def _shown(value: object) -> str:
    """A value on one line, whatever its ``repr`` does."""
    try:
        text = " ".join(repr(value).split())
    except Exception:
        text = f"a {type(value).__name__}"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
