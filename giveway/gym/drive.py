"""A drive through a crowd as a Gymnasium environment (extra ``gym``); see docs/gym.md.

The co-simulation is that of every run: SUMO, FMU, people, limits by lights and priority. It runs in
a thread of its own, in which the environment is the controller, as a plug-in. ``reset`` begins it;
the constructor starts nothing.
"""

import threading
from collections.abc import Mapping
from math import cos, sin
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from controller import Acceleration, Force, Observation, Setup
from giveway.api import simulate
from giveway.config import RunConfig
from giveway.config.files.layers import Layer
from giveway.config.files.loading import as_layer, load
from giveway.config.files.presets import parameters_of
from giveway.cosimulation.preflight import preflight
from giveway.ego.perception.false_detections import ids_of
from giveway.ego.perception.plugged_in_sensor import sensor_of
from giveway.errors import ConfigError, ControlError, InstallationError
from giveway.geometry.kernel import Array
from giveway.gym.picture import picture
from giveway.processes.interrupts import DeferredInterrupt
from giveway.results.run_result import RunResult
from giveway.run_data.progress import Ending
from sumo_scenarios import Scenario

try:
    import gymnasium
    from gymnasium import spaces
except ImportError as missing:
    raise InstallationError(
        "giveway.gym needs gymnasium; install it with: pip install 'giveway[gym]'"
    ) from missing

ID = "giveway/Drive-v0"
FAR = 100.0  # Largest distance ahead [m] in observations
FAST = 40.0  # Largest speed [m/s] in observations
LATERAL = 30.0  # Largest lateral distance [m] of people in observations
_AHEAD = np.linspace(0.0, 32.0, 33)  # Distances [m] of the way in pictures
_REAR = -10.0  # Farthest place [m] behind the front bumper of people in observations
_HARD = 10.0  # Largest acceleration [m/s^2] in observations
_DISCOMFORT = 0.02  # [s^3/m^2] per (m/s^2)^2 in a second: 4 m/s^2 cost as much as standing a third
_CONTACT = 100.0  # Cost [s] of hitting a person
_MOVES = 0.1  # Speed [m/s] below which the ego hits nobody
_CONTROLLER = "giveway.gym:Seat"

Dict = dict[str, NDArray[np.float32]]


class _Exchange:
    """The exchange between the environment and the run's thread: one of them always waits."""

    def __init__(self, action: str) -> None:
        self.action = action
        # each is held until the event
        self.asked, self.answered = threading.Lock(), threading.Lock()
        self.asked.acquire()
        self.answered.acquire()
        self.interrupt = DeferredInterrupt()
        self.setup: Setup | None = None
        self.seen: Observation | None = None
        self.around: Array = np.empty((0, 5))  # people near the ego, from ``_around``
        self.share = 0.0
        self.over = False
        self.result: RunResult | None = None
        self.error: BaseException | None = None


_here = threading.local()


class Seat:
    """The controller of an environment's run, which takes the environment's action."""

    def __init__(self, setup: Setup) -> None:
        self._exchange: _Exchange | None = getattr(_here, "exchange", None)
        self._setup = setup
        if self._exchange is not None:
            self._exchange.setup = setup

    def control(self, seen: Observation) -> Force | Acceleration:
        """Return the action that ``DriveEnv.step`` is called with."""
        exchange, limit = self._exchange, self._setup.force_limit
        if exchange is None:
            raise ConfigError(f"controller = '{_CONTROLLER}' is for giveway.gym.DriveEnv only")
        exchange.seen = seen
        exchange.asked.release()
        exchange.answered.acquire()
        if exchange.action == "acceleration":
            return Acceleration(exchange.share * limit / self._setup.mass, "action")
        return Force(exchange.share * limit, "action")


class DriveEnv(gymnasium.Env[Any, NDArray[np.float32]]):
    """One ego's drive through a scenario.

    * Action: (1,) within -1 to 1, the share of the largest force [N] or, with ``action =
      "acceleration"``, of the largest acceleration [m/s^2], which is that force over the mass.
    * Observation: ``ego`` (4,) speed [m/s], acceleration [m/s^2], the share of the force that acted
      last, what is left of the path [m]; ``ahead`` (5,) speed limit by lanes, lights, priority and
      vehicles [m/s], stop line [m], person on the way [m], vehicle in front [m], its speed [m/s];
      ``people`` (n, 5) of the nearest ones x ahead and y left of the front bumper [m], velocity
      along both [m/s], and 1 if there is a person.
    * Reward in each step, in seconds: h (v / v_r - 1), what the step loses against a free drive;
      less h 0.02 a^2 for comfort; less 100 for hitting a person with the front.
    * ``terminated``: the goal is reached, or a person is hit. ``truncated``: the time limit or
      the scenario's end. That step tells the last observation again, with reward 0.
      ``info["summary"]`` has then the run's numbers as of every run.
    * ``[safety] enabled`` is false unless the configuration says otherwise.
    * Seeds: ``reset(seed=s)`` is the run with ``seed = s``; without, it is drawn.

    Args:
        config: Configuration as for ``giveway.run``; its controller is the action.
        action: Meaning of actions.
        people: Number n of people in the observation.
        render_mode: ``"rgb_array"`` for :meth:`render`, or None.

    Raises:
        GivewayError: the configuration cannot be used, or has not exactly one ego.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}  # noqa: RUF012 - as in Env

    def __init__(
        self,
        config: Mapping[str, Any] | str | None = None,
        *,
        action: Literal["force", "acceleration"] = "acceleration",
        people: int = 8,
        render_mode: Literal["rgb_array"] | None = None,
    ) -> None:
        if render_mode not in {None, *self.metadata["render_modes"]}:
            raise ConfigError(f"render_mode = '{render_mode}': expected 'rgb_array' or None")
        self.render_mode = render_mode
        if action not in {"force", "acceleration"}:
            raise ConfigError(f"action = '{action}': expected 'force' or 'acceleration'")
        if people < 1:
            raise ConfigError(f"people = {people}: expected at least 1")
        self._layers = (
            Layer("DriveEnv", {"safety": {"enabled": False}}),
            as_layer(config if isinstance(config, str) else dict(config or {})),
            Layer("DriveEnv", {"controller": _CONTROLLER}),
        )
        self._action, self._people = action, people
        self._loaded(0)
        self._exchange: _Exchange | None = None
        self._thread: threading.Thread | None = None
        self.result: RunResult | None = None
        self.action_space = spaces.Box(-1.0, 1.0, (1,), np.float32)
        boxes = {
            "ego": _box([-FAST, -_HARD, -1.0, 0.0], [FAST, _HARD, 1.0, FAR]),
            "ahead": _box([0.0] * 4 + [-FAST], [FAST, FAR, FAR, FAR, FAST]),
            "people": _box(
                [[_REAR, -LATERAL, -5.0, -5.0, 0.0]] * people,
                [[FAR, LATERAL, 5.0, 5.0, 1.0]] * people,
            ),
        }
        self.observation_space = spaces.Dict(dict(boxes))
        self._bounds = {name: (box.low, box.high) for name, box in boxes.items()}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Dict, dict[str, Any]]:
        """Begin a run; ``options`` must be empty.

        Raises:
            GivewayError: the run cannot begin.
        """
        super().reset(seed=seed)
        if options:
            raise ConfigError(f"options = {options}: expected none; settings are the constructor's")
        self.close()
        drawn = int(self.np_random.integers(2**31)) if seed is None else seed % 2**31
        checked = preflight(*self._loaded(drawn))
        exchange = self._exchange = _Exchange(self._action)
        self.result = None

        def drive() -> None:
            _here.exchange = exchange
            try:
                exchange.result = simulate(checked, None, exchange.interrupt)
            except BaseException as error:  # it is reported in the waiting thread
                exchange.error = error
            finally:
                exchange.over = True
                exchange.asked.release()

        self._thread = threading.Thread(target=drive, name="giveway.gym", daemon=True)
        self._thread.start()
        exchange.asked.acquire()
        self._raise(exchange)
        if exchange.over:
            self._finish(exchange)
            ending = "" if self.result is None else self.result.ending
            raise ControlError(f"DriveEnv: the run ended before its ego departed ({ending})")
        return self._observed(exchange), {"seed": drawn} | self._told(exchange)

    def step(self, action: NDArray[np.float32]) -> tuple[Dict, float, bool, bool, dict[str, Any]]:
        """Apply an action for a control step.

        Raises:
            GivewayError: the run has failed.
        """
        exchange = self._exchange
        if exchange is None or exchange.setup is None or exchange.seen is None:
            raise gymnasium.error.ResetNeeded("reset() begins a run; step() goes on with it")
        exchange.share = float(np.clip(np.asarray(action, dtype=np.float64).ravel()[0], -1.0, 1.0))
        exchange.answered.release()
        exchange.asked.acquire()
        self._raise(exchange)
        observation, told = self._observed(exchange), self._told(exchange)
        seen, setup = exchange.seen, exchange.setup
        pace = seen.speed / setup.reference_speed - 1.0
        reward = setup.time_step * (pace - _DISCOMFORT * seen.acceleration**2)
        completed = truncated = hit = False
        if exchange.over:  # there is no further instant: the last one again, without a cost
            reward = 0.0
            self._finish(exchange)
            completed = self.result is not None and self.result.ending is Ending.COMPLETED
            truncated = not completed
        elif self._hits(seen.speed, exchange.around):
            hit = True
            reward -= _CONTACT
            self.close()
        if self.result is not None:
            told["summary"] = dict(self.result.summary)
        told["hit"] = hit
        return observation, reward, completed or hit, truncated, told

    def render(self) -> NDArray[np.uint8] | None:
        """Return the present instant from above, (320, 640, 3), or None without a render mode."""
        exchange = self._exchange
        if self.render_mode is None or exchange is None or exchange.seen is None:
            return None
        path = exchange.seen.path
        way = np.zeros((1, 2)) if path is None else _in_frame(path.poses(_AHEAD))
        return picture(self._body, self._radius, way, exchange.around[:, :4])

    def close(self) -> None:
        """End the run if there is one; its rows so far are in ``result``."""
        exchange = self._exchange
        if exchange is not None and not exchange.over:
            exchange.interrupt.requested = True
            exchange.answered.release()
            exchange.asked.acquire()
            self._finish(exchange)
        self._exchange = None

    def _finish(self, exchange: _Exchange) -> None:
        if self._thread is not None:
            self._thread.join()
        self._thread, self._exchange, self.result = None, None, exchange.result

    def _raise(self, exchange: _Exchange) -> None:
        error = exchange.error or (exchange.result.error if exchange.result else None)
        if error is not None:
            self._finish(exchange)
            raise error

    def _loaded(self, seed: int) -> tuple[RunConfig, Scenario]:
        """Return the run's configuration and scenario."""
        config, scenario = load([*self._layers, Layer("reset", {"seed": seed})])
        egos = config.each_ego()
        if len(egos) != 1:
            raise ConfigError(f"DriveEnv: {len(egos)} egos; expected exactly one")
        (own,) = egos
        sensor = sensor_of(own, config.time_step or 1.0)
        self._made_up = getattr(sensor, "false_detections", False)
        self._radius = parameters_of(config.crowd.preset).body_radius
        self._body = own.vehicle.length or 5.0, own.vehicle.width or 2.0
        self._half = self._body[1] / 2.0
        return config, scenario

    # --- observations -------------------------------------------------------------------------

    def _told(self, exchange: _Exchange) -> dict[str, Any]:
        seen = exchange.seen
        return {} if seen is None else {"time": seen.time, "position": seen.position}

    def _observed(self, exchange: _Exchange) -> Dict:
        seen, setup = exchange.seen, exchange.setup
        assert seen is not None
        assert setup is not None
        left = FAR if seen.path is None else seen.path.remaining()
        ego = [seen.speed, seen.acceleration, seen.force / setup.force_limit, left]
        gaps = [seen.stop_gap, seen.person_gap, seen.leader_gap]
        ahead = [min(seen.speed_limit, FAST), *(min(gap, FAR) for gap in gaps), seen.leader_speed]
        people = np.zeros((self._people, 5), dtype=np.float32)
        around = exchange.around = self._around(seen)
        if len(around):
            near = np.argsort((around[:, :2] ** 2).sum(axis=1), kind="stable")[: self._people]
            people[: len(near), :4] = around[near, :4]
            people[: len(near), 4] = 1.0
        told = {
            "ego": np.array(ego, dtype=np.float32),
            "ahead": np.array(ahead, dtype=np.float32),
            "people": people,
        }
        for name, values in told.items():
            low, high = self._bounds[name]
            np.minimum(values, high, out=values)
            np.maximum(values, low, out=values)
        return told

    def _around(self, seen: Observation) -> Array:
        """Return place [m] and velocity [m/s], ahead and left, of the people near the ego (m, 5).

        The last column is 0 for false detections, and 1 for everybody else.
        """
        if seen.people is None or seen.path is None or not len(seen.people.position):
            return np.empty((0, 5))
        x, y, heading = seen.path.poses(np.zeros(1))[0]
        c, s = cos(heading), sin(heading)
        turn = np.array([[c, -s], [s, c]])
        place = np.einsum("ij,jk", seen.people.position - [x, y], turn)
        velocity = np.einsum("ij,jk", seen.people.velocity, turn)
        near = (place[:, 0] > _REAR) & (place[:, 0] < FAR) & (np.abs(place[:, 1]) < LATERAL)
        there = np.ones(len(place), dtype=np.bool_)
        if self._made_up and seen.person_ids is not None:
            there = ids_of(seen.person_ids) >= 0
        around: Array = np.column_stack([place, velocity, there])[near]
        return around

    def _hits(self, speed: float, around: Array) -> bool:
        """Return whether the front touches a person while the ego drives."""
        beside = np.maximum(np.abs(around[:, 1]) - self._half, 0.0)
        touched = np.hypot(around[:, 0], beside) <= self._radius
        touched &= (around[:, 0] >= 0.0) | (beside == 0.0) & (around[:, 0] > -self._radius)
        return bool(speed > _MOVES and (touched & (around[:, 4] > 0.0)).any())


def _in_frame(poses: Any) -> Array:
    """Return the places of poses [m] as ahead and left of the first one."""
    x, y, heading = poses[0]
    c, s = cos(heading), sin(heading)
    place: Array = (np.asarray(poses)[:, :2] - [x, y]) @ np.array([[c, -s], [s, c]])
    return place


def _box(low: Any, high: Any) -> spaces.Box:
    return spaces.Box(np.array(low, dtype=np.float32), np.array(high, dtype=np.float32))


gymnasium.register(ID, entry_point="giveway.gym:DriveEnv")
