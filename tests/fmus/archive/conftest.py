"""Archives to be examined."""

from __future__ import annotations

import zipfile

import pytest

DESCRIPTION = b'<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"/>'


@pytest.fixture
def archive(tmp_path):
    """Writes an FMU with a model description and these members (name or ZipInfo -> bytes)."""

    def write(*members, description=DESCRIPTION, name="car.fmu"):
        path = tmp_path / name
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
            if description is not None:
                file.writestr("modelDescription.xml", description)
            for member, data in members:
                file.writestr(member, data)
        return path

    return write
