"""The command ``giveway calibrate``: parameters fitted to recorded trajectories."""

import math
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from giveway.cli.commands.behaviour_fit import fit_behaviour, journal_of
from giveway.cli.option_groups import FitSettings
from giveway.cli.screen.printing import escape, numbers_of, print_place, writing
from giveway.cli.screen.progress_bars import counting
from giveway.config.files.presets import SUFFIX, parameters_of, preset_text
from giveway.errors import ConfigError, ResultsError
from giveway.precompile import compile_kernels_once
from giveway.validation import Calibration, Dataset, calibrate, dataset_of, read_clips
from giveway.validation.behaviour.loss import lost
from giveway.validation.calibrating import DEFAULT, Fit, HeldOut
from giveway.validation.fitting import FACTOR
from pedestrian_model import VciParameters

DISPLACEMENT = "displacement"
_AIMS = ("behaviour", DISPLACEMENT)
_EVALUATIONS = 400  # Evaluations of a fit for displacement, at most


def calibrate_command(
    folders: list[Path],
    out: Path,
    datasets: list[str],
    fit: FitSettings,
    *,
    force: bool,
    quiet: bool,
) -> None:
    """Fit, print what the fit changes, and write the preset unless the fit is worse.

    Args:
        folders: Folders of the data sets, or parts of them.
        out: Preset file to write.
        datasets: Name or description of each folder's data set; one stands for all.
        fit: Settings of the fit.
        force: True to replace the file, and to write a fit that is worse.
        quiet: True to print nothing.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    if fit.aim not in _AIMS:
        raise ConfigError(f"--aim {fit.aim}: expected {' or '.join(_AIMS)}")
    if out.suffix != SUFFIX:
        raise ConfigError(f"--out {out}: expected the name of a preset file, like my_crowd{SUFFIX}")
    if out.exists() and not force:
        raise ResultsError(
            f"{out}: exists; replace it with --force or name another file with --out"
        )
    if len(datasets) not in {0, 1, len(folders)}:
        raise ConfigError(
            f"--dataset: given {len(datasets)} times for {len(folders)} folders; expected one for "
            "each folder in their order, or one for all"
        )
    described = [dataset_of(name) for name in datasets] or [dataset_of(None)]
    if len(described) == 1:
        described *= len(folders)
    places = list(zip(folders, described, strict=True))
    if fit.aim == DISPLACEMENT:
        if len(folders) > 1:
            raise ConfigError(f"--aim {DISPLACEMENT}: expected one folder; name one data set")
        parameters, provenance, worse = _by_displacement(console, places[0], fit)
    else:
        parameters, provenance, worse = fit_behaviour(console, places, fit, out)
    for remark in worse:
        console.print(remark, markup=False, highlight=False)
    if worse and not force:
        raise ConfigError(
            f"{out}: not written, since the fit is worse than {fit.start}: {worse[0]} Fit with "
            "--aim behaviour or from another --preset, or write it with --force"
        )
    text = preset_text(out.stem, parameters, {"made_by": "giveway calibrate", **provenance})
    with writing(out, "name another file with --out"):
        out.write_text(text, encoding="utf-8", newline="\n")
    journal_of(out).unlink(missing_ok=True)
    print_place(console, "Preset", out)


def _by_displacement(
    console: Console, place: tuple[Path, Dataset], fit: FitSettings
) -> tuple[VciParameters, dict[str, Any], list[str]]:
    """Fit the error of predictions; return parameters, provenance, and what is worse."""
    clips = read_clips(*place)
    compile_kernels_once(console)
    names = fit.parameters.split(",") if fit.parameters else DEFAULT
    with counting(console, "Fitting") as count:
        found = calibrate(
            clips,
            parameters_of(fit.start),
            [name.strip() for name in names],
            held_out=HeldOut(fit.held_out, fit.seed),
            own_pace=fit.own_pace,
            evaluations=fit.evaluations or _EVALUATIONS,
            progress=lambda done, of, best: count(done, of, f"error {best:.4f} m"),
        )
    settings = {
        "dataset": clips[0].dataset.name,
        "start": fit.start,
        "seed": fit.seed,
        "own_pace": fit.own_pace,
    }
    _print(console, found)
    worse = lost(found.start, found.parameters)
    before, after = found.touching
    if after > before:
        worse.append(f"In replays {after} pedestrians touch the vehicle, {before} before the fit.")
    return found.parameters, _provenance(found, settings), worse


def _provenance(found: Calibration, settings: dict[str, Any]) -> dict[str, Any]:
    """Return a description of how the preset was made, for readers of the file."""
    return {
        **settings,
        "fitted": list(found.fitted),
        "objective": "ADE [m] averaged over people in windows, then over the horizons",
        "training_clips": list(found.training),
        "held_out_clips": list(found.held_out),
        **_rounded("training", found.train),
        **(_rounded("held_out", found.test) if found.held_out else {}),
        "held_out_improves": found.test.improves,
        "touching_before": found.touching[0],
        "touching_after": found.touching[1],
        **_apart(found),
        "at_bound": list(found.at_bound),
        "evaluations": found.evaluations,
        "converged": found.converged,
    }


def _apart(found: Calibration) -> dict[str, float]:
    """Return the smallest distances between people [m], for cases in which any two meet."""
    names = (f"closest_people_{when}" for when in ("data", "before", "after"))
    return {
        name: round(value, 3)
        for name, value in zip(names, found.apart, strict=True)
        if math.isfinite(value)
    }


def _rounded(name: str, fit: Fit) -> dict[str, float | list[float]]:
    numbers: dict[str, float | list[float]] = {
        f"{name}_error_before": round(fit.before, 5),
        f"{name}_error_after": round(fit.after, 5),
    }
    if not math.isnan(fit.low):
        numbers[f"{name}_difference_interval"] = [round(fit.low, 5), round(fit.high, 5)]
    return numbers


def _print(console: Console, found: Calibration) -> None:
    values = Table(*numbers_of("before", "after"), title="Parameters")
    for name in found.fitted:
        before, after = (getattr(p, name) for p in (found.start, found.parameters))
        values.add_row(name, f"{before:.5g}", f"{after:.5g}")
    console.print(values)
    columns = numbers_of("clips", "before", "after", "difference [95 %]")
    errors = Table(*columns, title=escape("Displacement error [m], mean ADE of the horizons"))
    for name, clips, fit in (
        ("training", found.training, found.train),
        ("held out", found.held_out, found.test),
    ):
        if clips:
            errors.add_row(
                name, str(len(clips)), f"{fit.before:.4f}", f"{fit.after:.4f}", escape(_gap(fit))
            )
    console.print(errors)
    for remark in _remarks(found):
        console.print(remark, markup=False, highlight=False)


def _gap(fit: Fit) -> str:
    if math.isnan(fit.low):
        return f"{fit.difference:+.4f}"
    return f"{fit.difference:+.4f} [{fit.low:+.4f}, {fit.high:+.4f}]"


def _remarks(found: Calibration) -> list[str]:
    """Return remarks on what the fit shows and does not show."""
    said = []
    if not found.held_out:
        said.append("No clip was held out: nothing is known of other recordings.")
    elif found.test.improves:
        said.append("The held-out error improves, beyond what the choice of clips explains.")
    elif found.test.difference < 0.0:
        said.append(
            "The held-out error is less, but the interval does not exclude that it is chance."
        )
    else:
        said.append("The held-out error does NOT improve: this fit is of the training clips only.")
    before, after = found.touching
    said.append(f"Pedestrians that touch the vehicle in replays of all clips: {before} -> {after}.")
    data, at_start, now = found.apart
    said.append(
        f"The closest two people, centre to centre: {at_start:.2f} -> {now:.2f} m; "
        f"{data:.2f} m in the data."
    )
    if found.at_bound:
        said.append(
            f"At the end of its range (a factor of {FACTOR:g}): {', '.join(found.at_bound)}: the "
            "data do not determine it."
        )
    if not found.converged:
        said.append(f"Not converged after {found.evaluations} evaluations; see --evaluations.")
    return said
