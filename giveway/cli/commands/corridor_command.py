"""The command ``giveway data corridor``: people in recorded corridors, simulated and compared."""

from pathlib import Path

from rich.console import Console
from rich.table import Table

from giveway.cli.commands.behave_command import called, config_of
from giveway.cli.screen.printing import escape, numbers_of, print_place
from giveway.cli.screen.recordings import cite, counted, read
from giveway.errors import ConfigError, retold
from giveway.precompile import compile_kernels_once
from giveway.recordings import dataset_of
from giveway.results.folder import check_folder
from giveway.validation.corridors.comparison import BAR, DRAWS, Comparison, compare_in_corridors
from giveway.validation.corridors.output import FILES, write_corridors
from pedestrian_model import PedestrianModelError


def corridor_command(
    folder: Path,
    dataset: str | None,
    model: str,
    preset: str,
    free_speeds: tuple[float, float],
    out: Path | None,
    *,
    force: bool,
    quiet: bool,
) -> None:
    """Read recordings of corridors, simulate their people, print the comparison, and write it.

    Args:
        folder: Folder of the recordings.
        dataset: Name or description of the data set.
        model: Name of a bundled pedestrian model.
        preset: Preset of VCI.
        free_speeds: Mean and deviation [m/s] of the desired speeds of people who show none.
        out: Folder for the files, or None.
        force: Whether files there are replaced.
        quiet: Whether nothing is printed.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    described = dataset_of(dataset)
    mean, deviation = free_speeds
    config = config_of(model, preset, desired_speed_mean=mean, desired_speed_sd=deviation)
    if out is not None:
        check_folder(out, force=force, ours=FILES, writer="giveway data corridor")
    recordings = read(console, folder, described)
    compile_kernels_once(console)
    with (
        counted(console, "Simulating", len(recordings)) as advance,
        retold(PedestrianModelError, ConfigError),
    ):
        found = compare_in_corridors(recordings, config, advance)
    title = f"{described.name}, {called(model, preset)}"
    console.print(_table(found, title))
    cite(console, described)
    if out is not None:
        with console.status("Drawing ..."):
            write_corridors(found, title, out)
        print_place(console, "Tables and picture", out)


def _table(found: Comparison, title: str) -> Table:
    rows = found.table
    words = [
        f"mean speed [m/s] per density, flow [1/s] through the exit; {DRAWS} simulations",
        f"within {BAR:.0%}: {rows['within_bar'].sum()} of {len(rows)}",
    ]
    if len(found.free):
        shown = f"{found.free.mean():.2f} ± {found.free.std():.2f} m/s"
        words.append(f"{len(found.free)} recorded people are ever free, and walk at {shown} then")
    if found.left_out:
        words.append(f"{found.left_out} recordings are of no corridor")
    table = Table(
        *numbers_of("recorded", "simulated", "difference", f"within {BAR:.0%}"),
        title=escape(f"{title}: {found.people} people, {len(found.names)} corridors"),
        caption=escape("; ".join(words)),
    )
    for measure, of, _, recorded, simulated, difference, within in rows.to_numpy().tolist():
        known = simulated == simulated  # nan: simulated people are never so dense
        table.add_row(
            escape(f"{measure}, {of}"),
            f"{recorded:.2f}",
            f"{simulated:.2f}" if known else "-",
            f"{difference:+.0%}" if known else "-",
            "yes" if within else "no",
        )
    return table
