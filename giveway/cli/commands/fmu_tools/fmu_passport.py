"""The command ``giveway fmu passport``: what is known of a vehicle, as JSON and as a page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from fmus import FmuError
from fmus.archive.archive_check import open_archive
from fmus.checking import (
    CheckReport,
    Identification,
    Mpc,
    Trace,
    check,
    expected_of,
    identify,
    opener_of,
    openers_held,
    without_guards,
)
from fmus.checking.beside_fmpy import Beside, beside_fmpy
from fmus.checking.self_check import plain
from fmus.description.binaries import this_platform
from fmus.description.model import Model
from fmus.description.reading import read_model
from fmus.profile.preparation import Prepared, choose_profile, prepare
from fmus.profile.vehicle_profile import VehicleProfile
from fmus.text import printable
from giveway._version import __version__
from giveway.cli.guards.fmu_arguments import profile_in, require_fmu, require_number
from giveway.cli.screen.printing import print_place, writing
from giveway.errors import VehicleError, retold
from giveway.reports.passport_page import Section, passport_page

FORCE_LIMIT = 8000.0  # [N] largest force of the tests, as in check
STEP, HORIZON = 0.05, 15  # [s] control step, and steps of the MPC's horizon
UNITS = {  # of the numbers in the passport, by key
    **dict.fromkeys(("mass", "drive_mass", "brake_mass"), "kg"),
    **dict.fromkeys(("lag", "sensor_lag", "delay", "delay_of_inputs", "horizon"), "s"),
    **dict.fromkeys(("step", "finer", "time_step", "duration"), "s"),
    **dict.fromkeys(("speed", "speed_error", "power_from"), "m/s"),
    **dict.fromkeys(("position", "position_error"), "m"),
    "friction": "N·s/m",
    "limit": "m/s²",
    "rate": "m/s³",
    "largest_force": "N",
}
SEEN = {"limit", "power_from", "rate"}  # limits that a vehicle may not show
DRIVEN = ((0.0, 1.0), (0.5, 3.0), (0.0, 2.0), (-0.5, 4.0))  # shares of the force, durations [s]


def passport_command(path: Path, profile: Path | None, out: Path, mass: float | None) -> int:
    """Inspect, check and identify an FMU, and write its passport.

    Args:
        path: File of the FMU.
        profile: Profile of the FMU, or None to draft one from names and units.
        out: Folder for ``passport.json`` and ``passport.html``.
        mass: Mass of the vehicle [kg], or None if it is unknown.

    Returns:
        0 if every test passed; 1 if one failed.

    Raises:
        ConfigError: there is no such file, or the profile cannot be used.
        VehicleError: the FMU is refused.
        ResultsError: a file cannot be written.
    """
    require_fmu(path)
    if mass is not None:
        require_number("--mass", mass, 0.0, 1e6, "kg")
    given, console = profile_in(profile), Console()
    with retold(FmuError, VehicleError):
        digest, model = open_archive(path).sha256, read_model(path)
        chosen = choose_profile(path, given)
        prepared = prepare(path, step_size=STEP, profile=chosen)
    with console.status("Driving ...") as status:
        report = _checked(path, chosen, prepared, mass, lambda name: status.update(name))
        status.update("Step tests ...")
        found, problem = _identified(path, chosen)
        status.update("The same drive by FMPy ...")
        beside = beside_fmpy(prepared, _forces(report.expected.force))
    passport = {
        "giveway": __version__,
        "fmu": {"file": path.name, "sha256": digest, **_description(model, prepared)},
        "profile": chosen.model_dump(mode="json", exclude_unset=True),
        "check": {"passed": report.passed, "findings": [asdict(f) for f in report.findings]},
        "convergence": _convergence(report),
        "identification": {"problem": problem} if found is None else _model(found),
        "beside_fmpy": asdict(beside),
        "not_asked": _not_asked(report, found, prepared),
    }
    page = _page(passport, report, found)
    for name, text in (
        ("passport.json", json.dumps(passport, indent=2, allow_nan=False) + "\n"),
        ("passport.html", page),
    ):
        with writing(out / name, "name another folder with -o"):
            out.mkdir(parents=True, exist_ok=True)
            (out / name).write_text(text, encoding="utf-8")
        print_place(console, "Passport", out / name)
    console.print(_lead(report, found), highlight=False)
    return 0 if report.passed else 1


# ---- what is asked ----


def _checked(
    path: Path, profile: VehicleProfile, prepared: Prepared, mass: float | None, progress: Any
) -> CheckReport:
    free = without_guards(profile)
    return check(
        opener_of(path, step_size=STEP, profile=profile),
        expected_of(profile, mass=mass, force_limit=FORCE_LIMIT),
        step_size=STEP,
        fmu_step=prepared.step_plan.step,
        unguarded=opener_of(path, step_size=STEP, profile=free),
        held=openers_held(path, step_size=STEP, profile=free),
        progress=progress,
    )


def _identified(path: Path, profile: VehicleProfile) -> tuple[Identification | None, str]:
    opener = opener_of(path, step_size=STEP, profile=without_guards(profile))
    try:
        mpc = Mpc(STEP, HORIZON)
        return identify(opener, mpc, path=path, profile=profile), ""
    except FmuError as error:
        return None, plain(error)


def _forces(force: float) -> list[float]:
    return [2.0 * share * force for share, time in DRIVEN for _ in range(round(time / STEP))]


# ---- what is known ----


def _description(model: Model, prepared: Prepared) -> dict[str, Any]:
    return {
        "model": printable(model.name),
        "description": printable(model.description),
        "made_by": printable(model.generation_tool),
        "fmi_version": model.fmi_version,
        "interface": str(prepared.wiring.interface.kind),
        "platforms": list(model.platforms),
        "variables": len(model.variables),
        "continuous_states": model.states,
        "step": prepared.step_plan.step,
        "delay_of_inputs": prepared.step_plan.delay,
    }


def _convergence(report: CheckReport) -> dict[str, Any]:
    """Return the steps that were compared, and the largest differences of the two drives."""
    found = report.convergence
    if found is None or found.finer is None:
        return {"problem": "the FMU does steps of one length only" if found else "it did not drive"}
    numbers: dict[str, Any] = {"step": found.step, "finer": found.finer, "problem": found.problem}
    if len(found.traces) == 2:
        coarse, fine = found.traces
        for quantity in ("speed", "position"):
            one, two = getattr(coarse, quantity), getattr(fine, quantity)
            length = min(one.size, two.size)
            apart = float(np.abs(one[:length] - two[:length]).max())
            numbers[quantity] = apart if np.isfinite(apart) else None
    return numbers


def _model(found: Identification) -> dict[str, Any]:
    mass, friction = found.intervals
    return {
        **found.model.model_dump(mode="json"),
        "mass_interval": mass,
        "friction_interval": friction,
        "largest_force": found.largest_force,
        "drive_mass_interval": found.side_intervals[0],
        "brake_mass_interval": found.side_intervals[1],
        "poor": found.poor,
        "remarks": list(found.remarks),
    }


def _not_asked(report: CheckReport, found: Identification | None, prepared: Prepared) -> list[str]:
    traces = [*report.traces.values(), *(() if found is None else (*found.tests, found.validation))]
    points = []
    if traces:
        fastest, longest, hardest = (
            max(float(np.abs(values(trace)).max(initial=0.0)) for trace in traces)
            for values in (_speed, _time, _force)
        )
        points.append(
            f"speeds above {fastest:.3g} m/s, forces above {hardest:.0f} N, and drives longer than "
            f"{longest:.3g} s"
        )
    points += [
        "another control step than 0.05 s, other start values than those of the profile, and "
        f"other platforms than {this_platform()}",
        "grades: its input for them was 0, except at rest"
        if prepared.wiring.grade is not None
        else "grades: it has no input for them, and drives everywhere as on the level",
        "steering, tyres on wet or icy roads, temperature, wear and energy",
        "whether a real vehicle moves like this: nothing was compared with a measurement",
        "whether the FMU does harm: see 'An FMU that you do not trust' in docs/vehicles.md",
    ]
    return points


def _speed(trace: Trace) -> Any:
    return trace.speed


def _time(trace: Trace) -> Any:
    return trace.time


def _force(trace: Trace) -> Any:
    return trace.force


# ---- the page ----


def _lead(report: CheckReport, found: Identification | None) -> str:
    verdict = "passed" if report.passed else "failed"
    if found is None:
        return f"The check has {verdict}; no model was identified."
    model = found.model
    return (
        f"The check has {verdict}; M = {model.mass:.5g} kg, alpha = {model.friction:.4g} N·s/m, "
        f"lag {model.lag:.2g} s, dead time {model.delay:.2g} s."
    )


def _page(passport: Mapping[str, Any], report: CheckReport, found: Identification | None) -> str:
    from giveway.figures.vehicle_response import check_figure, identification_figure

    drawn = check_figure(report)
    beside = Beside(**passport["beside_fmpy"])
    sections = [
        Section("What it is", _rows(passport["fmu"])),
        Section("Check", [(f.verdict, f.name, f.text, f.remedy) for f in report.findings],
                figures=[] if drawn is None else [drawn]),
        Section("Steps halved", _rows(passport["convergence"])),
        Section("Identification", _rows(passport["identification"]),
                figures=[] if found is None else [identification_figure(found)]),
        Section("The same drive by FMPy", [] if beside.problem else [
            ("version", beside.fmpy), ("duration [s]", f"{beside.duration:.4g}"),
            ("largest difference of speed [m/s]", f"{beside.speed:.2g}"),
            *((("largest difference of position [m]", f"{beside.position:.2g}"),)
              if beside.position is not None else ()),
        ], points=[f"not compared: {beside.problem}"] if beside.problem else ()),
        Section("Profile", _rows(passport["profile"], {})),
        Section("What was not asked", points=passport["not_asked"]),
    ]  # fmt: skip
    footer = f"Written by giveway {passport['giveway']}; the same numbers are in passport.json."
    return passport_page(passport["fmu"]["file"], _lead(report, found), sections, footer)


def _rows(
    values: Mapping[str, Any], units: Mapping[str, str] = UNITS, prefix: str = ""
) -> list[tuple[str, str]]:
    """Return nested values as rows, with the tables' names before the keys."""
    rows = []
    for key, value in values.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            rows += _rows(value, units, f"{name}.")
        elif value not in ("", None):
            unit = units.get(key.removesuffix("_interval"), "")
            text = f"{_text(value)} {unit}".rstrip()
            interval = f"± {text} (95 %)" if key.endswith("_interval") else text
            rows.append((name.replace("_", " "), interval))
        elif key in SEEN:
            rows.append((name.replace("_", " "), "none seen"))
    return rows


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return "; ".join(_text(item) for item in value)
    return printable(str(value), 1000)
