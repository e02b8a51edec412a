"""Fixtures of the FMU tests: the shipped FMUs, and broken ones made from them."""

from __future__ import annotations

import zipfile
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest

from fmus import VehicleFmu, bundled_fmu, make_profile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


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
