"""Fixtures of the FMU tests: the shipped FMUs, and broken ones made from them."""

from __future__ import annotations

import zipfile
from typing import TYPE_CHECKING

import pytest

from fmus import bundled_fmu

if TYPE_CHECKING:
    from collections.abc import Callable
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
