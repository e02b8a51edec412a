"""The command ``giveway doctor``: the findings as a table, and an exit code for scripts."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from rich.console import Console

from giveway.cli.screen.printing import findings_table, print_json
from giveway.doctor import Finding, examine_environment, examine_scenario
from giveway.studies.folder.examination import examine_results, is_results

STYLES = {"ok": "green", "note": "cyan", "warning": "yellow", "error": "bold red"}


def doctor_command(scenario: str | None, *, as_json: bool = False) -> int:
    """Examine the environment, and the scenario or the results if some are named.

    Args:
        scenario: Name or path of a scenario, results folder of a run or study, or None.
        as_json: True to print the findings as JSON.

    Returns:
        1 if there is an error among the findings, 0 otherwise.
    """
    console = Console(quiet=as_json)
    with console.status("Examining the environment ..."):
        findings = examine_environment()
    print_findings(console, "Environment", findings)
    if scenario is not None and is_results(Path(scenario)):
        of_results = examine_results(Path(scenario))
        print_findings(console, "Results", of_results)
        findings += of_results
    elif scenario is not None:
        with console.status("SUMO tries the scenario ..."):
            of_scenario = examine_scenario(scenario)
        print_findings(console, "Scenario", of_scenario)
        findings += of_scenario
    errors = sum(finding.level == "error" for finding in findings)
    warnings = sum(finding.level == "warning" for finding in findings)
    console.print(_verdict(errors, warnings), highlight=False)
    if as_json:
        print_json(
            {
                "errors": errors,
                "warnings": warnings,
                "findings": [asdict(finding) for finding in findings],
            }
        )
    return 1 if errors else 0


def print_findings(console: Console, title: str, findings: Sequence[Finding]) -> None:
    """Print findings as a table, and commands among their remedies whole, so as to be copied."""
    commands = [found for found in findings if found.remedy.startswith("giveway ")]
    rows = (
        (found.level, found.subject, found.text, found.remedy)
        for found in findings
        if found not in commands
    )
    console.print(findings_table(title, STYLES, rows))
    for found in commands:
        style = STYLES[found.level] if found.level == "warning" else "dim"
        console.print(f"{found.subject}: {found.text}", style=style, markup=False)
        console.print(f"  {found.remedy}", highlight=False, markup=False, soft_wrap=True)


def _verdict(errors: int, warnings: int) -> str:
    if errors:
        return f"{errors} error{'s' * (errors > 1)}: a run will not work until this is corrected."
    if warnings:
        return f"No errors, {warnings} warning{'s' * (warnings > 1)}."
    return "All is well."
