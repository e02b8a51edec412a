"""Several threads step a crowd to the same bits as one."""

import gc
import os
import pickle
import threading
import time

import numpy as np
import pytest

from pedestrian_model import (
    Crowd,
    CrowdModel,
    DivergenceError,
    ParameterError,
    Surroundings,
    VciParameters,
    Vehicles,
    Walls,
)
from pedestrian_model.vci import model
from pedestrian_model.vci import threads as pool

THREADS = (2, 3, 8)


@pytest.fixture(autouse=True)
def _share_small_crowds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model, "THREADS_FROM", 1)


def place(rng: np.random.Generator, n: int, width: float, height: float) -> np.ndarray:
    """(n, 2) clusters and single people, some of them at the same place to the last bit."""
    x = rng.uniform(0.0, 1.0, (n, 2)) * (width, height)
    clustered = rng.random(n) < 0.2
    x[clustered] = x[0] + rng.normal(0.0, 2.0, (int(clustered.sum()), 2))
    twins = rng.integers(0, n, (2, n // 20))
    x[twins[0]] = x[twins[1]]
    return x


def draw(seed: int, n: int, cars: int) -> tuple[Crowd, Vehicles, Surroundings]:
    """A crowd with routes, signals and priority, among walls and cars that stand or move."""
    rng = np.random.default_rng(seed)
    width, height = rng.choice([3.0, 40.0, 200.0], 2)
    x = place(rng, n, width, height)
    ways = x[:, None] + rng.normal(0.0, 20.0, (n, 3, 2))
    crowd = Crowd.create(
        x,
        rng.normal(0.0, 1.0, (n, 2)) * (rng.random((n, 1)) < 0.8),
        rng.uniform(0.5, 2.0, n),
        list(ways),
        signals=list(rng.integers(-1, 2, (n, 3))),
    )
    if seed % 2:
        crowd.priority[:] = rng.uniform(0.0, 1.0, n)
    vehicles = Vehicles.create(
        rng.uniform(-5.0, width + 5.0, cars),
        rng.uniform(-5.0, height + 5.0, cars),
        rng.uniform(-3.0, 3.0, cars),
        rng.choice([0.0, 0.1, 8.0, -2.0], cars),
    )
    ends = rng.uniform(0.0, 1.0, (1 + seed % 9, 4)) * (width, height, width, height)
    walls = Walls.create(ends) if seed % 3 else None
    return crowd, vehicles, Surroundings(walls, np.array([True, False]))


def state(crowd: Crowd) -> bytes:
    return b"".join(array.tobytes() for array in crowd.state)


@pytest.mark.parametrize("seed", range(40))
def test_the_number_of_threads_does_not_show(seed: int) -> None:
    n = (99, 100, 101, 120, 332, 333, 700, 2500)[seed % 8]
    drawn = draw(seed, n, cars=(0, 1, 4, 5, 40)[seed % 5])
    time_step = 0.05 if seed % 4 else 0.1  # two sub-steps
    crowds = [drawn[0].copy() for _ in (1, *THREADS)]
    for threads, crowd in zip((1, *THREADS), crowds, strict=True):
        stepped = CrowdModel(time_step=time_step, threads=threads)
        for _ in range(4):
            stepped.advance(crowd, *drawn[1:])
    assert state(crowds[0]) != state(drawn[0])
    for crowd in crowds[1:]:
        assert state(crowd) == state(crowds[0])


def test_a_small_radius_and_a_coarsened_grid_do_not_show_either() -> None:
    parameters = VciParameters(interaction_radius=0.7)
    crowd, vehicles, surroundings = draw(3, 1500, cars=7)
    crowd.position[0] = 30_000.0, 20_000.0  # more cells than there is memory for
    one, four = (CrowdModel(parameters, threads=threads) for threads in (1, 4))
    after = state(one.step(crowd, vehicles, surroundings))
    assert state(four.step(crowd, vehicles, surroundings)) == after


def test_one_model_steps_crowds_that_grow_and_shrink() -> None:
    one, two = CrowdModel(), CrowdModel(threads=2)
    for n in (300, 2000, 150, 0, 2500):
        crowd, vehicles, surroundings = draw(n, max(n, 1), cars=3)
        crowd = crowd.select(np.arange(len(crowd)) < n)
        expected = state(one.step(crowd, vehicles, surroundings))
        assert state(two.step(crowd, vehicles, surroundings)) == expected


def crowd_threads() -> list[str]:
    return [t.name for t in threading.enumerate() if t.name.startswith("giveway-crowd")]


def test_no_thread_outlives_its_model() -> None:
    stepped, drawn = CrowdModel(threads=3), draw(1, 400, cars=1)
    stepped.step(*drawn)
    assert crowd_threads()
    del stepped
    gc.collect()
    until = time.monotonic() + 60.0
    while crowd_threads() and time.monotonic() < until:
        time.sleep(0.01)
    assert not crowd_threads()


def test_one_thread_starts_none() -> None:
    before = threading.active_count()
    CrowdModel().step(*draw(1, 2000, cars=1))
    assert threading.active_count() == before


def test_a_copy_by_pickle_has_threads_of_its_own() -> None:
    stepped, drawn = CrowdModel(threads=2), draw(1, 400, cars=1)
    after = state(stepped.step(*drawn))
    copy = pickle.loads(pickle.dumps(stepped))
    copy._constants = stepped._constants  # read-only, as the kernels have been compiled for
    assert state(copy.step(*drawn)) == after


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_steps_on() -> None:
    stepped, drawn = CrowdModel(threads=2), draw(1, 400, cars=1)
    after = state(stepped.step(*drawn))
    child = os.fork()
    if child == 0:
        os._exit(0 if state(stepped.step(*drawn)) == after else 1)
    until = time.monotonic() + 60.0
    while (done := os.waitpid(child, os.WNOHANG))[0] == 0 and time.monotonic() < until:
        time.sleep(0.01)
    if done[0] == 0:
        os.kill(child, 9)
        os.waitpid(child, 0)
    assert done == (child, 0)


def test_what_is_not_finite_is_told_as_by_one_thread() -> None:
    crowd, vehicles, surroundings = draw(1, 400, cars=1)
    crowd.velocity[123] = np.nan
    messages = []
    for threads in (1, 2):
        with pytest.raises(DivergenceError) as caught:
            CrowdModel(threads=threads).step(crowd, vehicles, surroundings)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]
    assert "pedestrian 123" in messages[0]


def test_what_goes_wrong_in_another_thread_is_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    walk = pool.step_domain

    def fail(arrays, memory, layout, domain, *rest) -> None:
        if domain == 1:
            raise MemoryError("in domain 1")
        walk(arrays, memory, layout, domain, *rest)

    monkeypatch.setattr(pool, "step_domain", fail)
    with pytest.raises(MemoryError, match="in domain 1"):
        CrowdModel(threads=2).step(*draw(1, 400, cars=1))


def test_an_interrupt_waits_for_the_other_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    walk, ended = pool.step_domain, threading.Event()

    def interrupted(arrays, memory, layout, domain, *rest) -> None:
        if domain == 0:
            raise KeyboardInterrupt
        time.sleep(0.05)
        walk(arrays, memory, layout, domain, *rest)
        ended.set()

    monkeypatch.setattr(pool, "step_domain", interrupted)
    with pytest.raises(KeyboardInterrupt):
        CrowdModel(threads=2).step(*draw(1, 400, cars=1))
    assert ended.is_set()


@pytest.mark.parametrize("threads", [0, -1, 257])
def test_a_number_of_threads_that_makes_no_sense(threads: int) -> None:
    with pytest.raises(ParameterError, match=f"threads = {threads}, expected 1 to 256"):
        CrowdModel(threads=threads)
