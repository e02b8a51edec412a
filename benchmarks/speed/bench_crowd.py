"""How fast is the crowd: one step against JuPedSim, a city, the prediction, ring or cell list.

    python benchmarks/speed/bench_crowd.py

One thread. All compared numbers are medians of interleaved rounds of the same process, so that the
ratios survive a noisy machine. JuPedSim's SocialForceModel (``pip install "jupedsim>=1.4,<1.5"``)
gets the same pedestrians: places, radius, desired speed, two-way goals far away, 0.5 persons/m^2,
the same time step, an open plane without walls within 100 m. It walks at C++ speed inside
``Simulation.iterate``; ours pays for a Python call in every step.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from pedestrian_model import (
    SIM,
    Crowd,
    CrowdModel,
    Predictor,
    Surroundings,
    Vehicles,
    Walls,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

try:
    import jupedsim
except ImportError:
    jupedsim = None

DENSITY = 0.5  # [1/m^2]
TIME_STEP = 0.05  # [s]
SPEED = 1.4  # [m/s]
ROUNDS = 9
MARGIN = 100.0  # [m] of empty plane round the crowd
BLOCK = 24.0  # [m] from street to street of the city
SIDEWALK = 4.0  # [m]
PEOPLE_PER_VEHICLE = 60


def places(n: int) -> tuple[NDArray[np.float64], float]:
    """(n, 2) jittered grid at the density, and the side of its square."""
    per_side = int(np.ceil(np.sqrt(n)))
    pitch = 1.0 / np.sqrt(DENSITY)
    grid = np.stack(np.meshgrid(np.arange(per_side), np.arange(per_side)), -1).reshape(-1, 2)[:n]
    jitter = np.random.default_rng(n).uniform(-0.3, 0.3, (n, 2))
    return (grid + 0.5 + jitter) * pitch, per_side * pitch


def goals(n: int, side: float) -> NDArray[np.float64]:
    """(n, 2) every other one to the far right, the others to the far left."""
    x = np.where(np.arange(n) % 2 == 0, side + 0.9 * MARGIN, -0.9 * MARGIN)
    return np.stack([x, np.full(n, side / 2.0)], axis=1)


def our_crowd(n: int) -> Crowd:
    x, side = places(n)
    return Crowd.create(x, np.zeros((n, 2)), SPEED, list(goals(n, side)[:, None]))


def jupedsim_crowd(n: int) -> Any:
    x, side = places(n)
    low, high = -MARGIN, side + MARGIN
    simulation = jupedsim.Simulation(
        model=jupedsim.SocialForceModel(),
        geometry=[(low, low), (high, low), (high, high), (low, high)],
        dt=TIME_STEP,
    )
    ways = []
    for goal in goals(2, side):
        stage = simulation.add_waypoint_stage(tuple(goal), 1.0)
        ways.append((simulation.add_journey(jupedsim.JourneyDescription([stage])), stage))
    for i in range(n):
        journey, stage = ways[i % 2]
        simulation.add_agent(
            jupedsim.SocialForceModelAgentParameters(
                position=(float(x[i, 0]), float(x[i, 1])),
                journey_id=journey,
                stage_id=stage,
                desired_speed=SPEED,
                radius=SIM.body_radius,
                mass=SIM.mass,
            )
        )
    return simulation


def seconds(run: Callable[[], object]) -> float:
    start = perf_counter()
    run()
    return perf_counter() - start


def interleaved(*runs: Callable[[], object]) -> list[float]:
    """The median time [s] of each of ``runs``, taken in turns."""
    for run in runs:
        run()
    times = [[seconds(run) for run in runs] for _ in range(ROUNDS)]
    return [median(column) for column in zip(*times, strict=True)]


def steps_of(model: CrowdModel, crowd: Crowd, vehicles: Vehicles, count: int) -> Callable[[], None]:
    def run() -> None:
        for _ in range(count):
            model.advance(crowd, vehicles)

    return run


def against_jupedsim() -> None:
    print(f"step of the crowd, {DENSITY} persons/m^2, dt = {TIME_STEP} s [ns per agent-step]")
    print(f"{'n':>8} {'ours':>8} {'JuPedSim':>9} {'ratio':>6}")
    for n, count in ((30, 400), (1_000, 20), (10_000, 3)):
        ours = steps_of(CrowdModel(time_step=TIME_STEP), our_crowd(n), Vehicles.empty(), count)
        scale = 1e9 / (n * count)
        if jupedsim is None:
            print(f"{n:>8} {interleaved(ours)[0] * scale:>8.0f} {'-':>9} {'-':>6}")
            continue
        simulation = jupedsim_crowd(n)
        mine, theirs = interleaved(ours, lambda s=simulation, c=count: s.iterate(c))
        print(f"{n:>8} {mine * scale:>8.0f} {theirs * scale:>9.0f} {theirs / mine:>6.1f}")
    if jupedsim is None:
        print('JuPedSim is not installed: pip install "jupedsim>=1.4,<1.5" to compare with it')
    else:
        print(f"JuPedSim {jupedsim.__version__}, SocialForceModel")


def sidewalk_walls(streets: int, length: float) -> Walls:
    """Both edges of a sidewalk along each street, in pieces of 10 m as of a map."""
    x = np.arange(-20.0, length + 100.0, 10.0)
    y = np.repeat(BLOCK * np.arange(streets), len(x))
    x = np.tile(x, streets)
    south = np.stack([x, y, x + 10.0, y], axis=1)
    north = np.stack([x + 10.0, y + SIDEWALK, x, y + SIDEWALK], axis=1)
    return Walls.create(np.concatenate([south, north]))


def city(n: int) -> tuple[Crowd, Vehicles, Surroundings]:
    """A crowd of n on sidewalks along parallel streets, at the density.

    Everybody walks from line to line, every 8 m, one of ten with a signal. In the streets there
    are vehicles, half of them standing, as many for as many people.
    """
    rng = np.random.default_rng(n)
    streets = int(np.ceil(np.sqrt(n / DENSITY / (BLOCK * SIDEWALK))))
    length = n / DENSITY / (streets * SIDEWALK)
    x, edge = np.linspace(0.0, length, n), BLOCK * (np.arange(n) % streets)
    ways = np.empty((n, 10, 2))
    ways[:, :, 0] = x[:, None] + 8.0 * np.arange(1, 11)
    ways[:, :, 1] = edge[:, None] + SIDEWALK / 2.0
    signals = np.full((n, 10), -1)
    signals[:, 4] = np.arange(n) % 8
    crowd = Crowd.create(
        np.stack([x, edge + rng.uniform(0.5, SIDEWALK - 0.5, n)], axis=1),
        np.tile([SPEED, 0.0], (n, 1)),
        SPEED,
        list(ways),
        passages=list(np.tile([1.0, 0.0, SIDEWALK / 2.0], (n, 10, 1))),
        signals=list(signals),
    )
    count = max(1, n // PEOPLE_PER_VEHICLE)
    vehicles = Vehicles.create(
        rng.uniform(0.0, length, count),
        BLOCK * rng.integers(0, streets, count) - 3.0,
        0.0,
        np.where(np.arange(count) % 2 == 0, 0.0, 8.0),
    )
    return crowd, vehicles, Surroundings(sidewalk_walls(streets, length), np.arange(8) % 2 == 0)


def constant_speed(vehicles: Vehicles, time_step: float, horizon: int) -> NDArray[Any]:
    """The poses (N, m, 7) at 0 ... N - 1 steps ahead, straight on at constant speed."""
    poses = np.repeat(vehicles.array[None], horizon, axis=0)
    driven = time_step * np.arange(horizon)[:, None] * vehicles.speed
    poses[:, :, 0] += driven * np.cos(vehicles.heading)
    poses[:, :, 1] += driven * np.sin(vehicles.heading)
    return poses


def streets() -> None:
    print(f"\ncity: sidewalks at {DENSITY} persons/m^2, way-points, signals, walls, vehicles")
    print(f"{'':>8} {'':>9} {'':>6} {'step':>18}   {'prediction N = 15':>17} {'join + leave':>13}")
    print(
        f"{'n':>8} {'vehicles':>9} {'walls':>6} {'[ms]':>8} {'[ns/person]':>11}"
        f" {'[ms]':>17} {'[ms]':>13}"
    )
    for n in (100, 1_000, 3_000, 10_000):
        crowd, vehicles, surroundings = city(n)
        model, predictor = CrowdModel(time_step=TIME_STEP), Predictor(time_step=TIME_STEP)
        poses = constant_speed(vehicles, TIME_STEP, predictor.horizon)
        leaving = np.arange(n) % 1_000 == 50
        joining, count = crowd.select(leaving), max(1, 3_000 // n)

        def walk(m: Any = model, c: Any = crowd, v: Any = vehicles, s: Any = surroundings) -> None:
            now = c.copy()
            for _ in range(20):
                m.advance(now, v, s)

        def predict(
            p: Any = predictor,
            c: Any = crowd,
            v: Any = poses,
            s: Any = surroundings,
            k: Any = count,
        ) -> None:
            for _ in range(k):
                p.predict(c, v, s)

        def turn_over(c: Any = crowd, gone: Any = leaving, new: Any = joining) -> None:
            c.select(~gone).concatenate(new)

        step, ahead, joined = interleaved(walk, predict, turn_over)
        print(
            f"{n:>8} {len(vehicles):>9} {len(surroundings.walls or ()):>6} {step * 50:>8.3f}"
            f" {step / 20 / n * 1e9:>11.0f} {ahead / count * 1e3:>17.2f} {joined * 1e3:>13.3f}"
        )


def prediction() -> None:
    print("\nprediction, wrapper included [us]")
    print(f"{'n':>8} {'N':>4} {'vehicles':>9} {'time':>8}")
    for n, horizon, cars in ((30, 15, 1), (30, 15, 3), (30, 30, 1), (10, 15, 1), (100, 15, 1)):
        crowd, predictor = our_crowd(n), Predictor(time_step=TIME_STEP, horizon=horizon)
        x = np.linspace(-4.0, 4.0, cars)
        poses = constant_speed(Vehicles.create(x, -3.0, 1.0, 3.0), TIME_STEP, horizon)

        def run(p: Predictor = predictor, c: Crowd = crowd, v: NDArray[Any] = poses) -> None:
            for _ in range(100):
                p.predict(c, v)

        print(f"{n:>8} {horizon:>4} {cars:>9} {interleaved(run)[0] * 1e4:>8.1f}")


def crossover() -> None:
    print("\nring (all pairs) against cell list [ns per agent-step]")
    print(f"{'n':>8} {'ring':>8} {'cells':>8}")
    for n in (30, 60, 100, 130, 160, 200, 250, 300):
        count = 6_000 // n
        ring, cells = (
            steps_of(CrowdModel(cell_list_from=limit), our_crowd(n), Vehicles.empty(), count)
            for limit in (10**9, 0)
        )
        a, b = (time * 1e9 / (n * count) for time in interleaved(ring, cells))
        print(f"{n:>8} {a:>8.0f} {b:>8.0f}")


if __name__ == "__main__":
    against_jupedsim()
    streets()
    prediction()
    crossover()
