"""Algebraic loops: told by the FMUs' dependencies, or perhaps there if an FMU tells none."""

from __future__ import annotations

import re
import zipfile

import pytest
from support.fmus.ssp import write_ssp

from fmus import FmuInterfaceError
from fmus.description.reading import read_model

CONNECTIONS = [("one.torque", "other.demand"), ("other.torque", "one.demand")]
CONNECTORS = {
    f"{part}.{name}": (kind, "N")
    for part in ("one", "other")
    for name, kind in (("demand", "input"), ("torque", "output"))
}


@pytest.fixture
def ring(zoo, tmp_path):
    """Writes two actuators, each driven by the other; dependencies: of each one's output."""
    plain = zoo.car(
        names={"force": "demand", "speed": "torque"},
        units={"speed": ("N", 1.0, 0.0)},
        outputs=("speed",),
        initial=(),
        file="actuator",
    )

    def write(*dependencies):
        parts = {}
        for name, told in zip(("one", "other"), dependencies, strict=True):
            parts[name] = tmp_path / f"{name}.fmu"
            with zipfile.ZipFile(plain) as old, zipfile.ZipFile(parts[name], "w") as new:
                for member in old.namelist():
                    data = old.read(member)
                    if member == "modelDescription.xml" and told is not None:
                        told_text = b'dependencies="%s"' % (b"1" if told else b"")
                        data = re.sub(rb"(<Outputs>\s*<Unknown )", rb"\1" + told_text + b" ", data)
                        assert b"dependencies" in data
                    new.writestr(member, data)
        return write_ssp(tmp_path / "ring.ssp", parts, CONNECTIONS, CONNECTORS)

    return write


def test_a_loop_that_both_tell_is_refused_by_its_names(ring, refused):
    path = ring(1, 1)
    loop = "other.torque -> one.demand -> one.torque -> other.demand -> other.torque"
    with refused(FmuInterfaceError, path, f"an algebraic loop: {loop}; leave out one"):
        read_model(path)


@pytest.mark.parametrize(("dependencies", "doubts"), [((1, 0), 0), ((0, 0), 0), ((1, None), 1)])
def test_a_state_between_breaks_it_and_silence_is_a_doubt(ring, dependencies, doubts):
    system = read_model(ring(*dependencies)).system
    assert len(system.doubts) == doubts
    assert all("perhaps an algebraic loop" in doubt for doubt in system.doubts)
