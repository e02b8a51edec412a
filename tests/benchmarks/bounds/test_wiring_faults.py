"""A sample of the wiring faults: a factor of two is a question, a reversed brake is refused."""

import pytest
import tomlkit
import wiring_faults as faults


@pytest.mark.parametrize("name", ["two", "brake reversed"])
def test_a_fault_does_not_run(zoo, tmp_path, name):
    options = faults.PLANTS["two forces"]
    fmu = zoo.car(**options, outputs=("speed",), initial=("speed",))
    profile = faults.with_fault(faults.right(zoo.profile(fmu), options["values"]), name)
    path = tmp_path / "car.toml"
    path.write_text(tomlkit.dumps(profile), encoding="utf-8")
    verdict, said = faults.verdict_of(fmu, path)
    assert verdict == faults.FAULTS[name][2]
    assert "\n" not in said
