"""Fixtures of the FMU tests: the shipped FMUs, and broken ones made from them."""

from __future__ import annotations

import zipfile
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest

from fmus import VehicleFmu, bundled_fmu, fmi, make_profile
from fmus.description.model import Channel, Kind
from fmus.description.reading import read_model

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fmus.interfaces.instance import Instance


@pytest.fixture(params=["2.0", "3.0"], ids=["fmi2", "fmi3"], scope="session")
def fmi_version(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="session")
def fmu(fmi_version: str) -> Path:
    return bundled_fmu(fmi_version)


@pytest.fixture
def remake(fmu: Path, tmp_path: Path) -> Callable[..., Path]:
    """A copy of the shipped FMU with some of its members left out or its description edited."""

    def make(
        *,
        keep: Callable[[str], bool] = lambda name: True,
        edit: Callable[[str], str] = lambda xml: xml,
        replace: Callable[[str], bytes | None] = lambda name: None,
    ) -> Path:
        path = tmp_path / "edited.fmu"
        with zipfile.ZipFile(fmu) as old, zipfile.ZipFile(path, "w") as new:
            for name in filter(keep, old.namelist()):
                data = replace(name) or old.read(name)
                if name == "modelDescription.xml":
                    data = edit(data.decode()).encode()
                new.writestr(name, data)
        return path

    return make


@pytest.fixture
def load(tmp_path: Path) -> Iterator[Callable[..., Instance]]:
    """Load an FMU; it is closed after the test."""
    with ExitStack() as stack:

        def loaded(path, kind=None, **options):
            model = read_model(path)
            interface = (
                model.interfaces[Kind(kind)] if kind else next(iter(model.interfaces.values()))
            )
            folder = tmp_path / f"extracted {len(list(tmp_path.iterdir()))} ä%"
            with zipfile.ZipFile(path) as archive:
                archive.extractall(folder)
            instance = fmi.load(model, interface, folder, **options)
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


@pytest.fixture
def open_car(zoo) -> Iterator[Callable[..., VehicleFmu]]:
    """Open a car of the zoo in this process; it is closed after the test.

    Keys of its profile's tables can be changed (None: left out). ``like``: the car whose profile
    it has.
    """
    with ExitStack() as stack:

        def opened(path, *, step=0.05, start_values=None, like=None, **tables):
            profile = make_profile(changed(zoo.profile(like or path), tables), "the test's profile")
            return stack.enter_context(
                VehicleFmu(path, step_size=step, profile=profile, start_values=start_values)
            )

        yield opened


def changed(values: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    for key, value in changes.items():
        if isinstance(value, dict) and isinstance(values.get(key), dict):
            changed(values[key], value)
        elif value is None:
            values.pop(key, None)
        else:
            values[key] = value
    return values


@pytest.fixture
def redescribed(tmp_path: Path) -> Callable[..., Path]:
    """A copy of an FMU with something else in its model description."""

    def make(path: Path, old: str, new: str) -> Path:
        copy = tmp_path / path.name
        with zipfile.ZipFile(path) as source, zipfile.ZipFile(copy, "w") as target:
            for name in source.namelist():
                data = source.read(name)
                if name == "modelDescription.xml":
                    assert old in data.decode()
                    data = data.decode().replace(old, new).encode()
                target.writestr(name, data)
        return copy

    return make
