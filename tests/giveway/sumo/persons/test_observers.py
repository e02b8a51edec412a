"""Which elements of additional files look for persons."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING

from giveway.sumo.persons.observers import Observer, declared

if TYPE_CHECKING:
    from pathlib import Path


def test_only_elements_that_detect_persons_are_found(tmp_path: Path) -> None:
    plain, packed = tmp_path / "plain.add.xml", tmp_path / "packed.add.xml.gz"
    plain.write_text(
        '<additional><inductionLoop id="a" detectPersons="walk"/>'
        '<inductionLoop id="b" detectPersons=""/><inductionLoop id="c" detectPersons="none"/>'
        '<edgeData id="d"/></additional>'
    )
    packed.write_bytes(
        gzip.compress(b'<additional><edgeData id="e" detectPersons="ride"/></additional>')
    )
    (tmp_path / "broken.xml").write_text('<additional detectPersons="walk">')
    files = [plain, packed, tmp_path / "broken.xml", tmp_path / "missing.xml"]
    assert declared(files) == [Observer("inductionLoop", "a"), Observer("edgeData", "e")]
