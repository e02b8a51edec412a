"""Small runs as tasks, some of which take their process along."""

from __future__ import annotations

import hashlib
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import psutil
import pytest

from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.studies.execution.perform import perform
from giveway.studies.identity import software_identity
from giveway.studies.record import RunRecord, Task

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

AT = 4.0  # [s] later than anything that is driven before the run


def _task(run: str, seed: int = 1, **settings: Any) -> Task:
    values = {"seed": seed, "time_limit": 1.0, "crowd": {"pedestrians": 3}, **settings}
    config, _ = load([Layer("the test", values)])
    key = hashlib.sha256(run.encode()).hexdigest()[:32]
    return Task(run, key, config.model_dump_json(), {}, software_identity())


@pytest.fixture(scope="session")
def task() -> Callable[..., Task]:
    """A run of 1 s with three pedestrians."""
    return _task


@pytest.fixture(scope="session")
def faulty(zoo: Any) -> Callable[..., Task]:
    """A run whose FMU does something wrong after 4 s, in the very process of the run."""

    def make(fault: str, *, time_limit: float = 6.0) -> Task:
        car: Path = zoo.car(behaviour=fault, at=AT)
        profile = str(car.with_suffix(".toml"))
        vehicle = {"fmu": str(car), "profile": profile, "isolation": "none"}
        return _task(fault, seed=4, time_limit=time_limit, controller="pid-paper", vehicle=vehicle)

    return make


@pytest.fixture(scope="session")
def healthy() -> tuple[Task, ...]:
    return tuple(_task(f"c1-s{seed}", seed) for seed in range(1, 7))


@pytest.fixture(scope="session")
def expected(healthy: tuple[Task, ...]) -> dict[str, dict[str, Any]]:
    """What the healthy runs give in this process."""
    return {task.run: _numbers(perform(task)) for task in healthy}


def _numbers(record: RunRecord) -> dict[str, Any]:
    """All of a record that must not depend on who made it; as text, since nan is not nan."""
    values = asdict(RunRecord.from_json(record.to_json()))
    del values["computing"]
    return {name: repr(value) for name, value in values.items()}


@pytest.fixture(scope="session")
def numbers() -> Callable[[RunRecord], dict[str, Any]]:
    return _numbers


def _is_pythons_own(process: psutil.Process) -> bool:
    """Whether it is multiprocessing's helper, which ends with this process."""
    try:
        return "resource_tracker" in " ".join(process.cmdline())
    except psutil.Error:
        return False


@pytest.fixture(scope="session")
def worker_of() -> Callable[[RunRecord], psutil.Process]:
    """The process that made a run."""
    return lambda record: psutil.Process(int(record.computing.worker.rpartition(":")[2]))


@pytest.fixture
def left_behind() -> Iterator[Callable[[], list[psutil.Process]]]:
    """Processes that have been started since, and are still there after some seconds."""
    before = {process.pid for process in psutil.Process().children(recursive=True)}

    def look() -> list[psutil.Process]:
        children = psutil.Process().children(recursive=True)
        new = [c for c in children if c.pid not in before and not _is_pythons_own(c)]
        return psutil.wait_procs(new, timeout=60.0)[1]

    yield look
    assert look() == []
