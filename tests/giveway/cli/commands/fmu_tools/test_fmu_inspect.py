"""``giveway fmu inspect``: what an FMU is, and a draft that a user can go on with."""

from __future__ import annotations

import json
import tomllib
import zipfile

import pytest

from fmus import bundled_fmu
from fmus.profile.vehicle_profile import read_profile
from giveway.cli.commands.fmu_tools.fmu_inspect import inspect_command


@pytest.fixture
def inspect(capsys, monkeypatch):
    """Run the command in a terminal of 100 columns; returns exit code, output and error."""
    monkeypatch.setenv("COLUMNS", "100")

    def run(path, draft=None, **options):
        code = inspect_command(path, draft, **options)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run


@pytest.fixture
def edited(zoo, tmp_path):
    """A car without binaries, some text of whose model description is replaced."""

    def make(old, new, **members):
        path = tmp_path / "edited.fmu"
        with zipfile.ZipFile(zoo.car()) as car, zipfile.ZipFile(path, "w") as archive:
            xml = car.read("modelDescription.xml").decode()
            assert old in xml
            archive.writestr("modelDescription.xml", xml.replace(old, new, 1))
            for name, data in members.items():
                archive.writestr(name, data)
        return path

    return make


def test_as_a_user_types_it(type_here):
    done = type_here("fmu", "inspect", bundled_fmu("2.0"))
    assert done.returncode == 0
    assert "LongitudinalVehicle" in done.stdout
    assert "[inputs.force]" in done.stdout


def test_for_a_script(type_here, zoo):
    done = type_here("fmu", "inspect", zoo.car(role="acceleration"), "--json")
    assert (done.returncode, done.stderr) == (0, "")
    told = json.loads(done.stdout)
    assert told["fmi_version"] == "2.0"
    assert "output" in {variable["causality"] for variable in told["variables"]}
    assert "inputs" in tomllib.loads(told["profile"])
    assert told["questions"] == []


def test_what_an_fmu_is(inspect, zoo):
    path = zoo.car(kind="both", role="drive_brake", units={"speed": ("km/h", 1 / 3.6, 0.0)})
    code, out, err = inspect(path)
    assert (code, err) == (0, "")
    for words in (
        "FMI 2.0",
        "co-simulation",
        "model-exchange",
        "runs here",
        "canGetAndSetFMUstate",
        "drive_force",
        "km/h",
        "a speed",
        "0.277778",
        "initial_speed",
    ):
        assert words in out
    assert "Local variables" not in out
    assert "state_speed" in inspect(path, everything=True)[1]


def test_nothing_is_loaded(inspect, zoo):
    code, _out, _err = inspect(zoo.car(behaviour="abort", phase="load"))
    assert code == 0


def test_the_draft_is_the_profile(inspect, zoo, tmp_path):
    draft = tmp_path / "car.toml"
    code, out, _err = inspect(zoo.car(units={"force": ("kN", 1000.0, 0.0)}), draft)
    assert code == 0
    assert "every guess is sure" in out
    profile = read_profile(draft)
    assert profile.inputs.force.variable == "force"
    assert draft.read_text(encoding="utf-8") in out.replace("\r", "")


def test_open_questions_are_listed(inspect, zoo, tmp_path):
    draft = tmp_path / "car.toml"
    code, out, _err = inspect(zoo.car(role="throttle_brake", units={"speed": None}), draft)
    assert code == 0
    assert "3 open questions" in out
    text = draft.read_text(encoding="utf-8")
    assert '# ? unit = "?"' in text
    assert "full_force" not in tomllib.loads(text)["inputs"]["throttle"]


def test_a_file_that_is_there_is_kept(inspect, zoo, tmp_path):
    draft = tmp_path / "car.toml"
    draft.write_text("mine")
    code, _out, err = inspect(zoo.car(), draft)
    assert code == 2
    assert "exists already" in err
    assert draft.read_text() == "mine"


def test_a_draft_that_cannot_be_written(inspect, zoo, tmp_path):
    code, _out, err = inspect(zoo.car(), tmp_path / "no" / "such" / "car.toml")
    assert code == 2
    assert "cannot be written" in err


def test_a_refused_file(inspect, tmp_path):
    path = tmp_path / "car.fmu"
    path.write_text("no FMU")
    code, out, err = inspect(path)
    assert (code, out) == (2, "")
    assert err.startswith(f"error: {path}: not a zip archive")


def test_long_lists_are_shortened(inspect, edited):
    spare = (
        f'<ScalarVariable name="spare{n}" valueReference="{1000 + n}" causality="parameter" '
        'variability="fixed"><Real start="1"/></ScalarVariable>'
        for n in range(30)
    )
    path = edited("</ModelVariables>", f"{''.join(spare)}</ModelVariables>")
    _code, short, _err = inspect(path)
    _code, long, _err = inspect(path, everything=True)
    assert "--all shows them" in short
    assert "spare29" not in short.partition("# Vehicle profile")[0]
    assert "spare29" in long.partition("# Vehicle profile")[0]


def test_an_fmu_for_other_platforms_is_told_apart(inspect, edited):
    code, out, _err = inspect(edited("", "", **{"binaries/nextstep/car.o": b""}))
    assert code == 0
    assert "nextstep" in out
    assert "does not run on" in out


def test_the_standards_wishes_are_no_refusals(inspect, edited):
    code, out, _err = inspect(edited('fmiVersion="2.0"', 'fmiVersion="2.0" x="y"'))
    assert code == 0
    assert "Not as the standard wants it" in out


def test_what_an_fmu_says_cannot_steer_the_terminal(inspect, edited):
    rude = "[bold]&#x9b;2J&#x202e;" + "long" * 5000
    path = edited("<fmiModelDescription", f'<fmiModelDescription description="{rude}"')
    code, out, _err = inspect(path)
    assert code == 0
    assert "[bold]?2J?" in out
    assert all(line.isprintable() for line in out.splitlines())
    assert len(out) < 10_000
