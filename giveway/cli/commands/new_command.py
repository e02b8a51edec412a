"""The command ``giveway new``: a folder with a scenario from a drawn street or a map."""

from pathlib import Path
from typing import Final

from rich.console import Console

from giveway.cli.commands.doctor_command import print_findings
from giveway.cli.screen.printing import escape, print_place, writing
from giveway.doctor import examine_scenario
from giveway.errors import ResultsError
from giveway.scenario_builder import EXAMPLE, Demand, write_scenario

_EXAMPLE: Final = Path("street.toml")


def new_command(
    source: Path | None, out: Path | None, demand: Demand, *, force: bool, quiet: bool
) -> None:
    """Write a scenario, and print the doctor's remarks on it.

    Args:
        source: Description of a street, or a map; None to write an example of the former.
        out: Folder for the scenario, or None for one of the source's name.
        demand: Traffic of a map.
        force: True to replace a scenario there.
        quiet: True to print nothing.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    if source is None:
        _write_example(console, force=force)
        return
    with console.status("netconvert builds the network ..."):
        folder, warnings = write_scenario(source, out, demand, force=force)
    print_place(console, "Scenario", folder)
    place = escape(str(folder))
    if warnings:
        told = f"netconvert had {warnings} remark(s) on the map: look at the network in netedit"
        console.print(told, highlight=False)
    if not quiet:
        _examine(console, folder)
    console.print(f"Drive there: giveway run {place}/", highlight=False, soft_wrap=True)


def _write_example(console: Console, *, force: bool) -> None:
    """Write the description of a street that can be edited."""
    if _EXAMPLE.exists() and not force:
        raise ResultsError(f"{_EXAMPLE}: exists; edit it, or replace it with --force")
    with writing(_EXAMPLE, "change to a folder of your own"):
        _EXAMPLE.write_text(EXAMPLE, encoding="utf-8", newline="\n")
    console.print(f"Edit {_EXAMPLE}, then: giveway new {_EXAMPLE}", highlight=False)


def _examine(console: Console, folder: Path) -> None:
    """Print the remarks of the doctor; findings without a remark are left out."""
    with console.status("SUMO tries the scenario ..."):
        findings = examine_scenario(folder)
    remarks = [finding for finding in findings if finding.level != "ok"]
    print_findings(console, "Remarks of the doctor", remarks)
