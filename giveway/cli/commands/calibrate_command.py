"""The command ``giveway calibrate``: parameters fitted to recorded trajectories."""

import math
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from giveway.cli.option_groups import FitSettings
from giveway.cli.screen.printing import escape, numbers_of, print_place, writing
from giveway.cli.screen.progress_bars import counting
from giveway.config.files.presets import SUFFIX, parameters_of, preset_text
from giveway.errors import ConfigError, ResultsError
from giveway.precompile import compile_kernels_once
from giveway.validation import Calibration, calibrate, dataset_of, read_clips
from giveway.validation.calibrating import Fit, HeldOut
from giveway.validation.fitting import FACTOR


def calibrate_command(
    clips_in: Path,
    out: Path,
    dataset: str | None,
    fit: FitSettings,
    *,
    force: bool,
    quiet: bool,
) -> None:
    """Fit, print the errors before and after the fit, and write the preset.

    Args:
        clips_in: Folder of the data set, or a part of it.
        out: Preset file to write.
        dataset: Name or description of the data set, or None to recognise it.
        fit: Settings of the fit.
        force: True to replace the file.
        quiet: True to print nothing.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    if out.suffix != SUFFIX:
        raise ConfigError(f"--out {out}: expected the name of a preset file, like my_crowd{SUFFIX}")
    if out.exists() and not force:
        raise ResultsError(
            f"{out}: exists; replace it with --force or name another file with --out"
        )
    names = [name.strip() for name in fit.parameters.split(",")]
    clips = read_clips(clips_in, dataset_of(dataset))
    first = parameters_of(fit.start)
    compile_kernels_once(console)
    with counting(console, "Fitting") as count:
        found = calibrate(
            clips,
            first,
            names,
            held_out=HeldOut(fit.held_out, fit.seed),
            own_pace=fit.own_pace,
            evaluations=fit.evaluations,
            progress=lambda done, of, best: count(done, of, f"error {best:.4f} m"),
        )
    settings = {
        "dataset": clips[0].dataset.name,
        "start": fit.start,
        "seed": fit.seed,
        "own_pace": fit.own_pace,
    }
    text = preset_text(out.stem, found.parameters, _provenance(found, settings))
    with writing(out, "name another file with --out"):
        out.write_text(text, encoding="utf-8", newline="\n")
    _print(console, found)
    print_place(console, "Preset", out)


def _provenance(found: Calibration, settings: dict[str, Any]) -> dict[str, Any]:
    """Return a description of how the preset was made, for readers of the file."""
    return {
        "made_by": "giveway calibrate",
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
