"""FMUs loaded and started one by one, below the vehicle."""

from __future__ import annotations

import zipfile
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from fmus import fmi
from fmus.description.binaries import binary_of
from fmus.description.model import Channel, Kind
from fmus.description.reading import read_model
from fmus.profile.tables import Stepping

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fmus.fmi.running import Instance


@pytest.fixture
def load(tmp_path: Path) -> Iterator[Callable[..., Instance]]:
    """Load an FMU; it is closed after the test."""
    with ExitStack() as stack:

        def loaded(path, kind=None, rewinds=True, **options):
            model = read_model(path)
            interface = (
                model.interfaces[Kind(kind)] if kind else next(iter(model.interfaces.values()))
            )
            folder = tmp_path / f"extracted {len(list(tmp_path.iterdir()))} ä%"
            with zipfile.ZipFile(path) as archive:
                archive.extractall(folder)
            binary, stepping = binary_of(model, interface), Stepping(**options)
            instance = fmi.load(model, interface, folder, binary, stepping, rewinds=rewinds)
            stack.callback(instance.close)
            return instance

        yield loaded


def channel(instance: Instance, name: str) -> Channel:
    """``u[2]`` is the second element of the array ``u``."""
    variable, _, element = name.partition("[")
    return Channel(instance.model.variables[variable], int(element[:-1]) - 1 if element else 0)


@pytest.fixture
def start() -> Callable[..., Instance]:
    """Start an instance; channels and start values by name."""

    def started(instance, values=None, inputs=("force",), outputs=("position", "speed")):
        instance.start(
            {channel(instance, name): value for name, value in (values or {}).items()},
            [channel(instance, name) for name in inputs],
            [channel(instance, name) for name in outputs],
        )
        return instance

    return started


@pytest.fixture
def run(load, start) -> Callable[..., Instance]:
    """Load and start an FMU, and do steps with constant inputs; the last status is kept."""

    def ran(
        path, inputs, steps, *, step=0.05, values=None, outputs=("position", "speed"), **options
    ):
        instance = start(load(path, **options), values, tuple(inputs), outputs)
        for index, value in enumerate(inputs.values()):
            instance.inputs[index] = value
        for k in range(steps):
            instance.status = instance.tick(k * step, step)
            if instance.status > 1:
                break
        return instance

    return ran
