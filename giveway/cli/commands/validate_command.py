"""The command ``giveway validate``: the pedestrian model compared with recorded trajectories."""

from collections.abc import Iterator
from pathlib import Path

import pandas as pd
from rich.console import Console
from rich.table import Table

from giveway.cli.screen.printing import escape, numbers_of, print_place
from giveway.cli.screen.progress_bars import counting
from giveway.config.files.presets import parameters_of, require_steady_preset
from giveway.precompile import compile_kernels_once
from giveway.results.folder import check_folder
from giveway.validation import Validation, dataset_of, read_clips, validate
from giveway.validation.contacts import DATA, ORDER
from giveway.validation.evaluation import EVERYWHERE, NEAR
from giveway.validation.output import FILES, write_validation
from giveway.validation.predictors import VCI
from giveway.validation.verdict import verdict


def validate_command(
    clips_in: Path, *, dataset: str | None, preset: str, out: Path | None, force: bool, quiet: bool
) -> None:
    """Read the clips, predict, print the tables, and write the folder.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    described = dataset_of(dataset)
    parameters = parameters_of(preset)
    folder = out or Path("results") / f"validation_{Path(preset).stem}"
    check_folder(folder, force=force, ours=FILES, writer="giveway validate")
    clips = read_clips(clips_in, described)
    step = 1.0 / described.frame_rate
    require_steady_preset(preset, step, "--preset")
    compile_kernels_once(console)
    with counting(console, "Predicting") as count:
        found = validate(clips, parameters, progress=lambda done, of: count(done, of, ""))
    with console.status("Drawing ..."):
        write_validation(found, parameters, folder)
    _print(console, found, preset)
    print_place(console, "Tables and pictures", folder)


def _print(console: Console, found: Validation, preset: str) -> None:
    with_vehicle = sum(clip.poses.shape[1] > 0 for clip in found.clips)
    console.print(
        f"{escape(found.clips[0].dataset.name)}: "
        f"{len(found.clips)} clips, {with_vehicle} with a vehicle, {found.pedestrians} "
        f"pedestrians, {len(found.cut)} windows; parameters {escape(preset)}",
        highlight=False,
    )
    near = f"within {found.protocol.near:g} m of a moving vehicle"
    for subset, title in ((EVERYWHERE, "everybody"), (NEAR, near)):
        rows = found.errors[found.errors["subset"] == subset]
        if rows["count"].sum():
            console.print(_errors(rows, f"Displacement errors [m], {title}"))
    if len(found.contacts):
        console.print(_contacts(found.contacts))
    else:
        console.print("No clip has a vehicle: nobody to touch.", highlight=False)
    console.print(
        f"The closest two people, centre to centre: {found.apart[DATA]:.2f} m in the data, "
        f"{found.apart[VCI]:.2f} m by the model.",
        highlight=False,
    )
    if len(found.prediction):
        console.print(_prediction(found.prediction, found.fit))
    else:
        console.print("drift: each fit has seen one of these clips; not judged.", highlight=False)
    for sentence in verdict(found.errors, found.prediction):
        console.print(escape(sentence), highlight=False)


def _prediction(rows: pd.DataFrame, fit: str) -> Table:
    """Return the table of drift and the best constant velocity per subset and horizon."""
    title = f"drift ({fit}) against the best constant velocity"
    caption = "FDE [m], negative log likelihood, share within the 95 % ellipse: both predictors"
    numbers = numbers_of("n", "FDE", "change [95 % interval]", "NLL", "95 %")
    table = Table(
        "people", "horizon", "baseline", *numbers[1:], title=escape(title), caption=escape(caption)
    )
    for _, row in rows.iterrows():
        low, high = 100.0 * row["change_low"], 100.0 * row["change_high"]
        table.add_row(
            row["subset"],
            f"{row['horizon']:g} s",
            row["baseline"],
            str(row["count"]),
            f"{row['fde']:.3f} / {row['baseline_fde']:.3f}",
            escape(f"{100.0 * row['change']:+.1f} % [{low:+.0f}, {high:+.0f}]"),
            f"{row['nll']:.2f} / {row['baseline_nll']:.2f}",
            f"{row['inside_0.95']:.0%} / {row['baseline_inside_0.95']:.0%}",
        )
    return table


def _errors(rows: pd.DataFrame, title: str) -> Table:
    """Return a table of ADE / FDE per predictor and horizon, with the FDE's intervals below."""
    caption = "ADE / FDE [95 % interval of the FDE, clips resampled]"
    first = rows.drop_duplicates("horizon")
    horizons = dict(zip(first["horizon"], first["count"], strict=True))
    columns = numbers_of(*(f"{horizon:g} s (n = {int(n)})" for horizon, n in horizons.items()))
    table = Table(*columns, title=escape(title), caption=escape(caption))
    for name in dict.fromkeys(rows["predictor"]):
        mine = rows[rows["predictor"] == name]
        table.add_row(name, *(_cell(mine[mine["horizon"] == horizon]) for horizon in horizons))
    return table


def _cell(rows: pd.DataFrame) -> str:
    ade, fde = (rows[rows["metric"] == metric].iloc[0] for metric in ("ADE", "FDE"))
    numbers = f"{ade['mean']:.2f} / {fde['mean']:.2f}"
    known = fde["low"] == fde["low"]  # not nan
    return f"{numbers} [{fde['low']:.2f}, {fde['high']:.2f}]" if known else numbers


def _contacts(contacts: pd.DataFrame) -> Table:
    pedestrians = int(contacts.loc[contacts["predictor"] == ORDER[0], "pedestrians"].sum())
    title = f"Touching the vehicle in whole clips, of {pedestrians}"
    table = Table(*numbers_of("touching", "closest [m]"), title=title)
    for row in _totals(contacts):
        table.add_row(*row)
    return table


def _totals(contacts: pd.DataFrame) -> Iterator[tuple[str, str, str]]:
    for name in ORDER:
        mine = contacts[contacts["predictor"] == name]
        yield name, str(int(mine["touching"].sum())), f"{mine['closest'].min():.2f}"
