"""What of an archive is unpacked, and the remarks on it."""

from __future__ import annotations

import zipfile

from fmus import make_profile
from fmus.description.binaries import this_platform
from fmus.profile.preparation import prepare, unpack


def test_libraries_are_unpacked_wherever_they_lie(zoo, tmp_path):
    car, path = zoo.car(), tmp_path / "car.fmu"
    beside = ("lib/libtyre.so.2", "binaries/common/libaxle.so", "sources/libdoor.so", "data/m.csv")
    others = ("binaries/win32/car.dll", "binaries/x86-windows/a.dll", "sources/a.c")
    with zipfile.ZipFile(car) as source, zipfile.ZipFile(path, "w") as target:
        for name in source.namelist():
            # the library has a name of its own
            target.writestr(name.replace("/car.", "/wheels."), source.read(name))
        for name in (*beside, *others, "documentation/index.html"):
            target.writestr(name, b"")
    prepared = prepare(path, step_size=0.05, profile=make_profile(zoo.profile(car), "test"))
    assert prepared.binary.endswith(f"wheels{this_platform().suffix}")
    (note,) = (note for note in prepared.notes if "TMPDIR" not in note)
    assert note.startswith("its only library is called wheels.")
    folder = tmp_path / "unpacked"
    folder.mkdir()
    unpack(prepared, folder)
    found = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}
    assert found >= {*beside, prepared.binary}
    assert not found & {*others, "documentation/index.html"}
