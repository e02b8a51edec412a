"""The command ``giveway fmu check``: a vehicle FMU's dry run as a table and a picture."""

from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

from rich.console import Console

from fmus import FmuError
from fmus.checking import (
    CheckReport,
    Finding,
    check,
    expected_of,
    opener_of,
    openers_held,
    without_guards,
)
from fmus.checking.remedies import tried
from fmus.checking.scale import CLASS_MASSES
from fmus.checking.self_check import plain
from fmus.checking.standing import NAME as STANDING
from fmus.profile.bundled import is_bundled
from fmus.profile.preparation import choose_profile, prepare
from fmus.profile.vehicle_profile import VehicleAxis, VehicleProfile
from fmus.text import printable
from giveway.cli.guards.fmu_arguments import profile_in, require_fmu, require_number, save_picture
from giveway.cli.option_groups import DryRun
from giveway.cli.screen.printing import findings_table, print_json, print_place
from giveway.errors import ConfigError

# tests that an edited axis does not mend
_OF_STEPS = {"step halving", "starts", "reproducible", STANDING}
_NOTHING = "none of the lines that were tried mends it"
_STYLES = {
    "pass": "green", "skip": "cyan", "warn": "yellow", "ask": "bold magenta", "fail": "bold red",
}  # fmt: skip


def check_command(path: Path, profile: Path | None, trial: DryRun) -> int:
    """Dry-run a vehicle FMU, print the findings, and draw its response.

    Args:
        path: File .fmu.
        profile: Profile of the FMU, or None to draft one from names and units.
        trial: Settings of the dry run. Without a folder no picture is drawn. A profile's [model]
            comes before its mass and friction. Without a mass the controller assumes 1000 kg, and
            nothing is known of the vehicle.

    Returns:
        0 if every test passed, with or without warnings; 1 if a test failed.

    Raises:
        ConfigError: there is no such file, or a value or the profile cannot be used.
        ResultsError: the picture cannot be written.
    """
    require_fmu(path)
    step, out, mass, ego_class, friction, force_limit, speed, as_json = trial
    require_number("--step", step, 0.0, 1.0, "s")
    if mass is not None:
        require_number("--mass", mass, 0.0, 1e6, "kg")
    if ego_class is not None and ego_class not in CLASS_MASSES:
        raise ConfigError(
            f"--ego-class {printable(ego_class, 40)}: expected one of {', '.join(CLASS_MASSES)}"
        )
    require_number("--friction", friction, -1e-300, 1e6, "N.s/m")
    require_number("--force-limit", force_limit, 0.0, 1e6, "N")
    require_number("--speed", speed, -1e-300, 70.0, "m/s")
    given = profile_in(profile)
    console = Console(quiet=as_json)
    try:
        chosen = choose_profile(path, given)
        fmu_step = prepare(path, step_size=step, profile=chosen).step_plan.step
    except FmuError as error:
        return _conclude(console, path, [Finding("fits", "fail", plain(error))], as_json=as_json)
    with console.status("Driving ...") as status:
        free = without_guards(chosen)
        report = check(
            opener_of(path, step_size=step, profile=chosen),
            expected_of(
                chosen,
                mass=mass,
                vehicle_class=ego_class,
                friction=friction,
                force_limit=force_limit,
                start_speed=speed,
            ),
            step_size=step,
            fmu_step=fmu_step,
            unguarded=opener_of(path, step_size=step, profile=free),
            held=openers_held(path, step_size=step, profile=free),
            progress=lambda name: status.update(f"Driving: {name} ..."),
        )
        status.update("Trying remedies ...")
        findings = [_profile_found(path, profile, chosen), *_with_remedies(path, report, step)]
    code = _conclude(console, path, findings, as_json=as_json)
    if out is not None:
        _draw(console, report, path, out)
    return code


def _with_remedies(path: Path, report: CheckReport, step: float) -> list[Finding]:
    """Return the findings; a line that mends the profile is in them only if it was tried."""
    open_ones = {f.name for f in report.findings if f.verdict in ("fail", "ask")} - _OF_STEPS
    if not open_ones:
        return report.findings
    remedy = tried(path, report.expected, step_size=step)
    found = []
    for finding in report.findings:
        if finding.name in open_ones:
            if remedy is not None:
                line = f"write {remedy.lines}: tried, and the vehicle then drives and stops right"
                finding = replace(finding, remedy=line)
            elif finding.verdict == "fail":
                finding = replace(finding, remedy=_NOTHING)
        found.append(finding)
    return found


def _profile_found(path: Path, file: Path | None, profile: VehicleProfile) -> Finding:
    name = "profile"
    if file is not None:
        return Finding(name, "pass", str(file))
    if is_bundled(path):
        return Finding(name, "pass", "giveway's own FMU")
    inputs, outputs = (
        [
            f"{role} = {', '.join(axis.names)}" + (f" [{axis.unit}]" if axis.unit else "")
            for role, axis in table
            if isinstance(axis, VehicleAxis)
        ]
        for table in (profile.inputs, profile.outputs)
    )
    return Finding(
        name,
        "pass",
        f"drafted from names and units: {printable(', '.join(inputs + outputs))}",
    )


def _conclude(console: Console, path: Path, findings: Sequence[Finding], *, as_json: bool) -> int:
    rows = ((f.verdict, f.name, printable(f.text, 1000), f.remedy) for f in findings)
    console.print(findings_table(f"Check of {printable(path.name, 60)}", _STYLES, rows))
    failed = sum(finding.verdict == "fail" for finding in findings)
    warned = sum(finding.verdict == "warn" for finding in findings)
    asked = sum(finding.verdict == "ask" for finding in findings)
    console.print(_verdict(failed, warned, asked), highlight=False)
    if as_json:
        print_json(
            {
                "fmu": str(path),
                "failed": failed,
                "warned": warned,
                "asked": asked,
                "findings": [asdict(finding) for finding in findings],
            }
        )
    return 1 if failed else 0


def _verdict(failed: int, warned: int, asked: int) -> str:
    if failed:
        return f"{failed} test{'s' * (failed > 1)} failed: a run with this FMU would be wrong."
    if asked:
        return f"Passed, but for {asked} question{'s' * (asked > 1)} that only you can answer."
    if warned:
        return f"Passed, with {warned} warning{'s' * (warned > 1)}."
    return "Passed."


def _draw(console: Console, report: CheckReport, path: Path, folder: Path) -> None:
    from giveway.figures.vehicle_response import check_figure

    verdict = "passed" if report.passed else "failed"
    figure = check_figure(report, title=f"{printable(path.name, 60)}: check {verdict}")
    if figure is not None:
        file = folder / f"{path.stem}_check.png"
        save_picture(figure, file)
        print_place(console, "Picture", file)
