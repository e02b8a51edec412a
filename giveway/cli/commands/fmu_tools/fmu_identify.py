"""The command ``giveway fmu identify``: M and alpha of a vehicle FMU, written into its profile."""

import tomllib
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
from rich.table import Column, Table
from rich.text import Text

from fmus import FmuError
from fmus.checking import (
    Identification,
    Mpc,
    identify,
    opener_of,
    require_converged,
    without_guards,
)
from fmus.checking.profile_file import profile_text, with_model
from fmus.profile.preparation import choose_profile, prepare
from fmus.profile.vehicle_profile import VehicleProfile
from fmus.text import printable
from giveway.cli.guards.fmu_arguments import profile_in, require_fmu, require_number, save_picture
from giveway.cli.option_groups import StepTests
from giveway.cli.screen.printing import escape, print_place, writing
from giveway.config.files.schema_names import PROFILE, with_schema
from giveway.errors import ConfigError, VehicleError, retold


def identify_command(
    path: Path, profile: Path | None, tests: StepTests, speeds: Sequence[float]
) -> None:
    """Find M and alpha by step tests, print them, and write the profile with them.

    Args:
        path: File .fmu.
        profile: Profile of the FMU, or None for ``tests.out`` if it exists, else for a draft.
        tests: Settings of the step tests. Without a profile to write, the model is only printed;
            without a picture, none is drawn.
        speeds: Speeds from which the tests start [m/s].

    Raises:
        ConfigError: a file, a value or the profile cannot be used.
        VehicleError: the FMU failed, does not respond like a vehicle, or the fit is poor.
        ResultsError: a file cannot be written.
    """
    require_fmu(path)
    out, step, horizon, force_limit, _, picture, force = tests
    require_number("--step", step, 0.0, 1.0, "s")
    require_number("--horizon", horizon, 1, 200, "steps")
    if force_limit is not None:
        require_number("--force-limit", force_limit, 0.0, 1e7, "N")
    for speed in speeds or (-1.0,):
        require_number("--speeds", speed, -1e-300, 70.0, "m/s")
    if profile is None and out is not None and out.exists():
        profile = out
    if out is not None and out.exists() and not force and not _same(out, profile):
        raise ConfigError(f"{out}: exists; name another file with -o, or replace it with --force")
    given = profile_in(profile)
    console = Console()
    with retold(FmuError, VehicleError):
        chosen = choose_profile(path, given)
        fmu_step = prepare(path, step_size=step, profile=chosen).step_plan.step
        mpc = Mpc(step, horizon, force_limit)
        found = _identified(console, path, chosen, fmu_step, mpc, speeds)
    console.print(_summary(path, found))
    for remark in found.remarks:
        console.print(f"[yellow]note[/yellow] {escape(remark)}", highlight=False, soft_wrap=True)
    if out is not None and not found.poor:
        text = with_model(_text(path, profile, chosen), found.model)
        with writing(out, "name another with -o"):
            out.write_text(text, encoding="utf-8")
        print_place(console, "Profile", out)
    if picture is not None:
        from giveway.figures.vehicle_response import identification_figure

        save_picture(identification_figure(found, title=_title(path, found)), picture)
        print_place(console, "Picture", picture)
    if found.poor:
        raise VehicleError(
            f"{path}: the fit is poor: {found.poor}; no model is written. The picture and 'giveway "
            "fmu check' show what it does instead"
        )


def _same(out: Path, profile: Path | None) -> bool:
    return profile is not None and profile.exists() and out.samefile(profile)


def _identified(
    console: Console,
    path: Path,
    profile: VehicleProfile,
    fmu_step: float,
    mpc: Mpc,
    speeds: Sequence[float],
) -> Identification:
    # A filtered speed would end hard drives: the guards' judgement is that of 'check'.
    opener = opener_of(path, step_size=mpc.step_size, profile=without_guards(profile))
    columns = (TextColumn("Step tests"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("")
        require_converged(opener, fmu_step, path=path, force=0.5 * (mpc.force_limit or 8000.0))
        return identify(
            opener,
            mpc,
            path=path,
            profile=profile,
            speeds=speeds,
            progress=lambda done, total: progress.update(task, completed=done, total=total),
        )


def _summary(path: Path, found: Identification) -> Table:
    model, (mass, friction) = found.model, found.intervals
    table = Table(
        "",
        Column(justify="right"),
        "",
        title=Text(f"{printable(path.name, 60)}: M v' + alpha v = u"),
        title_justify="left",
        show_header=False,
        box=None,
        pad_edge=False,
    )
    rows = [
        ("M", f"{model.mass:.6g}", f"kg ± {_small(mass)} (95 %)"),
        ("alpha", f"{model.friction:.6g}", f"N.s/m ± {_small(friction)} (95 %)"),
    ]
    sides = (("Drive", model.drive), ("Brake", model.brake))
    for (name, side), half in zip(sides, found.side_intervals, strict=True):
        if side is None:
            rows.append((name, "?", "not determined by the tests"))
            continue
        rows += [
            (f"{name}: M", f"{side.mass:.5g}", f"kg ± {_small(half)} (95 %)"),
            ("  lag, dead time", f"{side.lag:.2g}, {side.delay:.2g}", "s"),
            ("  largest force over M", _seen(side.limit), "m/s²"),
            ("  fastest change of it", _seen(side.rate), "m/s³"),
        ]
        if side.power_from is not None:
            rows.append(("  constant power from", f"{side.power_from:.3g}", "m/s"))
    rows += [
        ("Lag of the speed output", f"{model.sensor_lag:.2g}", "s"),
        ("Largest force of the tests", f"{found.largest_force:.0f}", "N"),
        ("R² in a drive not fitted", f"{model.r_squared:.4f}", ""),
        ("Speed error, one step", _small(model.speed_error), "m/s RMS"),
        (f"Position error, {model.horizon:g} s", _small(model.position_error), "m (95 %)"),
    ]
    for row in rows:
        table.add_row(*row)
    return table


def _small(value: float) -> str:
    """Return a number with two digits, and rounding errors as 0."""
    return f"{value:.2g}" if value > 1e-9 else "0"


def _seen(limit: float | None) -> str:
    return "none seen" if limit is None else f"{limit:.3g}"


def _title(path: Path, found: Identification) -> str:
    model = found.model
    return (
        f"{printable(path.name, 60)}: M = {model.mass:.5g} kg, alpha = {model.friction:.4g} N s/m"
    )


def _text(path: Path, file: Path | None, profile: VehicleProfile) -> str:
    """Return the profile's text, with the user's comments if the file exists."""
    if file is not None:
        return file.read_text(encoding="utf-8-sig")
    from fmus.profile.bundled import is_bundled

    if not is_bundled(path):
        from fmus.description.reading import read_model
        from fmus.profile.draft_profile import draft_profile

        text = draft_profile(read_model(path)).toml
        tomllib.loads(text)
        return with_schema(text, PROFILE)
    text = profile_text(profile, f"{path.name}: how giveway drives it (docs/vehicles.md)")
    return with_schema(text, PROFILE)
