"""The command ``giveway calibrate``: parameters fitted to recorded trajectories."""

from pathlib import Path

from rich.console import Console

from giveway.cli.commands.behaviour_fit import fit_behaviour, journal_of
from giveway.cli.option_groups import FitSettings
from giveway.cli.screen.printing import print_place, writing
from giveway.config.files.presets import SUFFIX, preset_text
from giveway.errors import ConfigError, ResultsError
from giveway.recordings import dataset_of


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
    parameters, provenance, worse = fit_behaviour(console, places, fit, out)
    for remark in worse:
        console.print(remark, markup=False, highlight=False)
    if worse and not force:
        raise ConfigError(
            f"{out}: not written, since the fit is worse than {fit.start}: {worse[0]} Fit "
            "from another --preset, or write it with --force"
        )
    text = preset_text(out.stem, parameters, {"made_by": "giveway calibrate", **provenance})
    with writing(out, "name another file with --out"):
        out.write_text(text, encoding="utf-8", newline="\n")
    journal_of(out).unlink(missing_ok=True)
    print_place(console, "Preset", out)
