"""What ``export_controller`` and ``giveway export controller`` write."""

from __future__ import annotations

import dataclasses
import hashlib
import importlib.util
import re
import zipfile
from typing import TYPE_CHECKING, Any

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu

from fmus import describe
from fmus.errors import FmuBuildError, FmuFileError, FmuVariableError
from fmus.sources.export import bundled_controller, export_controller
from fmus.sources.parameters import ControllerParameters
from giveway.errors import ConfigError, ResultsError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

# No value is the default, and hardly one has few digits.
ODD = ControllerParameters(
    mass=1234.5678901234567,
    friction=0.1 + 0.2,
    time_step=1 / 30,
    reference_speed=10 / 3,
    safe_distance=7.7,
    margin=0.123456789,
    buffer_distance=9.9,
    speed_min=0.1,
    speed_max=19.99,
    force_limit=7654.321,
    force_rate_limit=987.654321,
    proportional_gain=300.1,
    integral_gain=0.0,
    derivative_gain=1e-17,
    horizon=123,
    mpc=False,
)


@pytest.mark.parametrize(
    "parameters", [ControllerParameters(), ODD, ControllerParameters(horizon=2)]
)
def test_fmpys_validation_has_no_findings(
    parameters: ControllerParameters, fmi_version: Any, tmp_path: Path
) -> None:
    fmu = export_controller(tmp_path / "c.fmu", parameters, fmi_version=fmi_version)
    assert validate_fmu(str(fmu)) == []
    read_model_description(
        str(fmu), validate=True, validate_variable_names=True, validate_model_structure=True
    )


def test_the_binary_has_the_start_values_of_the_description(
    fmi_version: str, new_host: Callable[..., Any]
) -> None:
    host = new_host(fmi_version, ODD, initialised=False)
    for entry in dataclasses.fields(ODD):
        assert host.get(entry.metadata["symbol"]) == getattr(ODD, entry.name), entry.name
    told = {v.name: v.start for v in host.description.modelVariables if v.start is not None}
    for name in set(told) - {"mpc", "obstacle_position"}:
        assert host.get(name) == float(told[name]), name
    assert told["mpc"] == "false"


def test_every_quantity_has_a_declared_unit(fmi_version: Any) -> None:
    description = read_model_description(str(bundled_controller(fmi_version)))
    declared = {unit.name for unit in description.unitDefinitions}
    units = {v.name: v.unit for v in description.modelVariables if v.type in {"Real", "Float64"}}
    assert set(units.values()) == declared
    assert {units[name] for name in ("force", "u_max", "du_max")} == {"N"}
    assert {units[name] for name in ("speed", "speed_limit", "reference_speed", "v_r")} == {"m/s"}
    assert {units[name] for name in ("position", "gap", "d_safe")} == {"m"}


def test_fmi_2_has_an_input_per_step_and_fmi_3_an_array(tmp_path: Path) -> None:
    p = ControllerParameters(horizon=3)
    two = read_model_description(str(export_controller(tmp_path / "2.fmu", p)))
    three = read_model_description(str(export_controller(tmp_path / "3.fmu", p, fmi_version="3.0")))
    places = [v.name for v in two.modelVariables if v.name.startswith("obstacle")]
    assert places == [f"obstacle_position[{i}]" for i in (1, 2, 3)]
    (array,) = (v for v in three.modelVariables if v.name == "obstacle_position")
    assert array.dimensions[0].variable.name == "N"


def test_outputs_declare_that_they_depend_on_every_input(fmi_version: Any) -> None:
    description = read_model_description(str(bundled_controller(fmi_version)))
    inputs = {v.name for v in description.modelVariables if v.causality == "input"}
    for unknown in description.outputs:
        assert {v.name for v in unknown.dependencies} == inputs


def test_the_same_parameters_give_the_same_bytes(fmi_version: Any, tmp_path: Path) -> None:
    one = export_controller(tmp_path / "1.fmu", ODD, fmi_version=fmi_version).read_bytes()
    two = export_controller(tmp_path / "2.fmu", ODD, fmi_version=fmi_version).read_bytes()
    assert one == two
    same = export_controller(tmp_path / "3.fmu", fmi_version=fmi_version)
    assert same.read_bytes() == bundled_controller(fmi_version).read_bytes()


def test_exports_can_be_told_apart_and_named_by_their_token(tmp_path: Path) -> None:
    one = describe(export_controller(tmp_path / "1.fmu")).guid
    two = describe(export_controller(tmp_path / "2.fmu", ODD)).guid
    assert one != two
    assert len(two) < 255  # libcosim unpacks into a folder of this name
    assert set(two) <= set("{}-_") | {c for c in map(chr, range(128)) if c.isalnum()}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"mass": 0.0}, "controller FMU: mass = 0.0: expected a finite number > 0 [kg]"),
        ({"horizon": 201}, "horizon = 201: expected a whole number from 2 to 200 [steps]"),
        ({"speed_max": 0.0}, "speed_max = 0.0: expected a finite number > 0 [m/s]"),
        ({"friction": 30000.0}, "friction * time_step / mass = 1.5: expected at most 1"),
    ],
)
def test_impossible_parameters_are_refused(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(FmuVariableError) as error:
        ControllerParameters(**wrong)
    assert message in str(error.value)


def test_what_cannot_be_exported_is_said(tmp_path: Path) -> None:
    with pytest.raises(FmuBuildError, match=r"FMI 1\.0: expected one of 2\.0, 3\.0"):
        export_controller(tmp_path / "c.fmu", fmi_version="1.0")  # type: ignore[arg-type]
    with pytest.raises(FmuFileError, match="cannot be written"):
        export_controller(tmp_path / "nowhere" / "c.fmu")


@pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None,
    reason="ziglang is not installed: pip install giveway[build]",
)
def test_a_rebuild_gives_the_shipped_bytes(tmp_path: Path, monkeypatch: Any) -> None:
    from fmus.sources.fmu_files import CONTROLLER_RECIPE, build

    monkeypatch.setenv("ZIG_LOCAL_CACHE_DIR", str(tmp_path / "cache"))  # really compile
    for path in build(tmp_path / "elsewhere", (CONTROLLER_RECIPE,)):
        shipped = bundled_controller().parent / path.name
        digests = [hashlib.sha256(file.read_bytes()).hexdigest() for file in (path, shipped)]
        assert digests[0] == digests[1], path.name


def test_the_sources_are_inside_and_named_for_those_who_compile() -> None:
    with zipfile.ZipFile(bundled_controller("2.0")) as archive:
        two = set(archive.namelist())
        told_2 = re.findall(r'<File name="(.*?)"', archive.read("modelDescription.xml").decode())
    with zipfile.ZipFile(bundled_controller("3.0")) as archive:
        three = set(archive.namelist())
        text = archive.read("sources/buildDescription.xml").decode()
        told_3 = re.findall(r'<SourceFile name="(.*?)"', text)
    assert {f"sources/{name}" for name in told_2} == {n for n in two if n.endswith(".c")}
    assert {f"sources/{name}" for name in told_3} == {n for n in three if n.endswith(".c")}
    assert [*told_2[:-1], "fmi3.c"] == told_3


# ---- the command ----


MPC = {"controller": "mpc-paper"}


def export(settings: dict[str, Any], out: Path, **options: Any) -> int:
    from giveway.cli.commands.export_command import export_command

    return export_command(None, None, settings, out, **options)


def test_the_command_writes_the_effective_configuration(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = {
        "controller": "mpc-paper",
        "time_step": 0.1,
        "vehicle": {"mass": 1500.0, "friction": 50.0, "force_limit": 5000.0},
        "regulation": {"reference_speed": 3.0, "safe_distance": 6.0},
        "controller_options": {"horizon": 20, "proportional_gain": 300.0},
    }
    out = tmp_path / "mpc.fmu"
    assert export(settings, out, fmi="3.0") == 0
    start = {v.name: v.start for v in read_model_description(str(out)).modelVariables}
    told = {name: float(start[name]) for name in ("dt", "M", "alpha", "v_r", "d_safe", "N")}
    assert told == {"dt": 0.1, "M": 1500, "alpha": 50, "v_r": 3, "d_safe": 6, "N": 20}
    assert (float(start["u_max"]), float(start["K_p"]), start["mpc"]) == (5000, 300, "true")
    assert "MPC of 20 steps, PID as fallback, every 0.1 s" in capsys.readouterr().out


def test_the_command_exports_the_pid_alone(tmp_path: Path) -> None:
    out = tmp_path / "pid.fmu"
    assert export({"controller": "pid-paper"}, out) == 0
    start = {v.name: v.start for v in read_model_description(str(out)).modelVariables}
    assert start["mpc"] == "false"


def test_the_command_refuses_in_one_line(tmp_path: Path) -> None:
    out = tmp_path / "mpc.fmu"
    out.write_bytes(b"mine")
    with pytest.raises(ResultsError, match="exists; replace it with --force"):
        export(MPC, out)
    assert out.read_bytes() == b"mine"
    assert export(MPC, out, force=True) == 0
    with pytest.raises(ResultsError, match=r"expected the name of an \.fmu file"):
        export(MPC, tmp_path / "mpc.txt")
    with pytest.raises(ResultsError, match="does not exist; create it first"):
        export(MPC, tmp_path / "nowhere" / "mpc.fmu")
    with pytest.raises(ConfigError, match="an exported controller has no lanes; give a speed"):
        export({**MPC, "regulation": {"reference_speed": "lane"}}, tmp_path / "other.fmu")
    with pytest.raises(ConfigError, match=r"--fmi 1\.0: expected 2\.0 or 3\.0"):
        export(MPC, tmp_path / "other.fmu", fmi="1.0")
    with pytest.raises(ConfigError, match="the configuration has no ego"):
        export(MPC | {"ego": {"none": True}}, tmp_path / "other.fmu")
    with pytest.raises(ConfigError, match="friction alone would turn the vehicle round"):
        export(MPC | {"vehicle": {"friction": 30000.0}}, tmp_path / "other.fmu")
    for other in ("mpc", "pid-tuned"):
        with pytest.raises(ConfigError, match=f"{other}: only the paper's .* --controller mpc-pap"):
            export({"controller": other}, tmp_path / "other.fmu")
    with pytest.raises(ConfigError, match=r"\[safety\] enabled = true: .*with --no-safety"):
        export(MPC | {"safety": {"enabled": True}}, tmp_path / "other.fmu")
    assert not (tmp_path / "other.fmu").exists()
