"""Archives to be examined, and how a refusal has to look."""

from __future__ import annotations

import re
import zipfile

import pytest

DESCRIPTION = b'<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"/>'


@pytest.fixture
def refused():
    """The error is of this class, on one line, and its message names all of these."""

    def expect(kind, *named):
        lookaheads = "".join(f"(?=.*{re.escape(str(word))})" for word in named)
        return pytest.raises(kind, match=rf"^{lookaheads}[^\n]+\Z")

    return expect


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
