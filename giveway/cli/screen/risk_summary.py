"""The summary of a risk in a terminal."""

from dataclasses import astuple

from rich.console import Console
from rich.table import Table

from giveway.cli.screen.printing import escape, numbers_of
from giveway.risk.cause_tables import given_event_row
from giveway.risk.causes import components_of, conditions, events_known
from giveway.risk.estimators import LEAST_EVENTS, LEAST_VECTORS
from giveway.risk.events import MAIS3
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.severity import Severity
from giveway.risk.tables import per_kilometre, severities_of

_LISTED = 5  # Largest number of runs that are listed


def print_risk(console: Console, folder: RiskFolder) -> None:
    """Print the probability with its interval, the doubts, and the runs with the event."""
    definition, estimate = folder.plan.definition, folder.estimate
    kilometre = per_kilometre(folder, estimate)
    share = f"{100.0 * definition.confidence:g} %"
    table = Table(*numbers_of("estimate", f"{share} from", "to"), box=None)
    met = estimate.probability > 0.0
    for name, value, low, high in (
        ("per run", estimate.probability, estimate.low, estimate.high),
        ("per km", kilometre.rate, kilometre.low, kilometre.high),
    ):
        shown = [f"{value:.3g}" if met else "-", f"{low:.3g}" if met else "0", f"{high:.3g}"]
        if high == high:  # not nan: no distance is known
            table.add_row(name, *shown)
    console.print(
        f"Probability of the event '{escape(definition.event)}' by {definition.method}: "
        f"{estimate.events:,} of {estimate.runs:,} runs have it",
        highlight=False,
    )
    console.print(table)
    if not met:
        console.print(
            f"The event was not met: the upper bound is one-sided, at {share} (about 3/n for 95 % "
            "of n plain runs).",
            highlight=False,
        )
    if definition.event == MAIS3 and estimate.failed:
        console.print(
            f"In {estimate.failed:,} runs it is not known whether there was an injury: a child was "
            "hit, or a speed was outside the curve's validity, or there was no result. They count "
            "in the upper bound.",
            highlight=False,
        )
    for doubt in estimate.doubts:
        console.print(f"[yellow]The interval may not hold:[/] {escape(doubt)}", highlight=False)
    _print_why(console, folder)
    if definition.why:
        _print_given_event(console, folder)
    _print_severity(console, folder)
    _print_runs(console, folder)


def _print_why(console: Console, folder: RiskFolder) -> None:
    """Print the share of each group of inputs in the criticality's variance."""
    if not folder.indices:
        return
    table = Table(*numbers_of("alone", "from", "to", "in all", "from", "to"), box=None)
    for one in folder.indices:
        first = one.first, one.first_low, one.first_high
        total = one.total, one.total_low, one.total_high
        table.add_row(escape(one.group), *(f"{share:.2f}" for share in (*first, *total)))
    console.print("Share of the criticality's variance (Sobol indices)", highlight=False)
    console.print(table)
    used = folder.indices[0].used
    if used < LEAST_VECTORS:
        console.print(
            f"[yellow]The indices mean little:[/] they are from {used} base vectors; expected "
            f"{LEAST_VECTORS} or more",
            highlight=False,
        )


def _print_given_event(console: Console, folder: RiskFolder) -> None:
    """Print the inputs that differ most given the event, or that they are not known."""
    found = conditions(folder)[:_LISTED]
    known = events_known(folder)
    if not found and components_of(folder):
        console.print(
            f"The inputs given the event are not known: {known:,} different vectors have it; "
            f"expected {LEAST_EVENTS} or more: raise the budget",
            highlight=False,
        )
    if not found:
        return
    table = Table(*numbers_of("index", "from", "to", "median", "given the event"), box=None)
    for one in found:
        index = (f"{value:.2g}" for value in astuple(one.index))
        medians = (f"{values[1]:.4g}" for values in (one.own, one.given))
        shown = medians if one.component.is_number else ("", given_event_row(one)["shares"])
        table.add_row(escape(one.component.name), *index, *map(escape, shown))
    console.print(
        f"Inputs given the event, from {known:,} vectors: the share of its variance that each "
        "explains alone",
        highlight=False,
    )
    console.print(table)


def _print_severity(console: Console, folder: RiskFolder) -> None:
    """Print the probability of each injury at a frontal contact by each curve."""
    found = [one for one in severities_of(folder) if one.impacts]
    for outcome in dict.fromkeys(one.outcome for one in found):
        mine = [one for one in found if one.outcome == outcome]
        means = [one.mean for one in mine if one.holds_for_adults]
        spread = ""
        if len(means) > 1:
            spread = f"; the curves differ by a factor of {max(means) / min(means):.1f}"
        told = ", ".join(_by_curve(one) for one in mine)
        console.print(
            f"Probability of {outcome} at a frontal contact in these runs: {told}{spread}",
            highlight=False,
        )


def _by_curve(one: Severity) -> str:
    outside = one.impacts - one.valid
    told = f"{outside} of {one.impacts} contacts outside validity"
    if not one.valid:
        return f"outside validity ({one.curve}; {outside} of {one.impacts} contacts)"
    return f"{100.0 * one.mean:.2g} % ({one.curve}{f'; {told}' if outside else ''})"


def _print_runs(console: Console, folder: RiskFolder) -> None:
    """Print the worst runs with the event, and how to make one again."""
    found = [(folder.plan.criticality(run, record), run.id) for run, record in folder.runs]
    worst = sorted(((c, run) for c, run in found if c >= 0.0), reverse=True)
    if worst:
        names = ", ".join(run for _, run in worst[:_LISTED])
        more = f", and {len(worst) - _LISTED:,} more in events.csv" if len(worst) > _LISTED else ""
        console.print(f"Runs with the event, the worst first: {names}{more}", highlight=False)
        console.print(
            f"Make one again: giveway rerun {escape(str(folder.path))} {worst[0][1]}",
            highlight=False,
            soft_wrap=True,
        )
