"""The dry run of a vehicle FMU: a few drives, and a finding for each property they test."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from fmus.checking import observations as observe
from fmus.checking.answers import measure
from fmus.checking.coarse import coarse, is_vehicle
from fmus.checking.expected import GENTLE, Expected
from fmus.checking.findings import Finding
from fmus.checking.judgement import judge, roles_of, told_of
from fmus.checking.manoeuvres import Attempt, Opener, Phase, Trace, try_to_drive
from fmus.checking.self_check import Convergence, convergence, milliseconds, plain, remedy
from fmus.checking.standing import NAME, standing, stays
from fmus.errors import FmuCrashError, FmuError, FmuOutputError, FmuStepError
from fmus.isolation import processes_reused
from fmus.profile.vehicle_profile import VehicleProfile

DEFAULT_MASS = 1000.0  # [kg] M of the controllers' model if no mass is given
FASTEST_START = 4.0  # [m/s] speed of the rolling start if the run starts at 0
DRIVE, COAST, BRAKE = 3.0, 3.0, 5.0  # [s] durations of the phases

_DRIVES = ("idle", "response", "again", "rolling")
_NAMES = {  # name of the finding about a drive that failed
    "idle": "stands still",
    "response": "drives",
    "again": "reproducible",
    "rolling": "start speed",
}


@dataclass
class CheckReport:
    """The result of a check.

    Attributes:
        findings: Findings in the order of the tests.
        traces: Traces of the drives that ran, by name.
        expected: Properties that were expected.
        convergence: Result of the step-halving test, or None if it was not run.
        filtered: True if the speed output was found to lag behind the position.
    """

    expected: Expected
    findings: list[Finding] = field(default_factory=list)
    traces: dict[str, Trace] = field(default_factory=dict)
    convergence: Convergence | None = None
    filtered: bool = False

    @property
    def passed(self) -> bool:
        """Return whether no test failed."""
        return all(finding.verdict != "fail" for finding in self.findings)


def expected_of(
    profile: VehicleProfile | None = None,
    *,
    mass: float | None = None,
    vehicle_class: str | None = None,
    friction: float = 100.0,
    force_limit: float = 8000.0,
    start_speed: float = FASTEST_START,
) -> Expected:
    """Return the assumptions about a vehicle.

    Args:
        profile: Profile of the vehicle, for advice on its lines.
        mass: Mass [kg] of the vehicle, which is also M of the controller's model, or None if it is
            unknown. Then M is that of the profile's [model], or 1000 kg without one.
        vehicle_class: Vehicle class of SUMO, from which the mass is roughly known.
        friction: Friction alpha of the controller's model [N.s/m].
        force_limit: Largest force u_max [N].
        start_speed: Start speed of the rolling start [m/s].
    """
    told = told_of(profile, mass, vehicle_class, flag="--mass", limit_flag="--force-limit")
    model = profile.model if profile is not None else None
    assumed = mass is None and model is None
    mass = DEFAULT_MASS if mass is None else mass
    if model is not None:
        mass, friction = model.mass, model.friction
    force = min(force_limit, GENTLE * mass)
    return Expected(mass, friction, start_speed, force, force_limit, profile, told, assumed)


@processes_reused()
def check(
    opener: Opener,
    expected: Expected,
    *,
    step_size: float,
    fmu_step: float | None = None,
    unguarded: Opener | None = None,
    held: Callable[[float], Opener] | None = None,
    progress: Callable[[str], None] | None = None,
) -> CheckReport:
    """Dry-run a vehicle. Errors of the FMU become findings.

    Args:
        opener: Function that opens the vehicle.
        expected: Assumptions about the vehicle, from :func:`expected_of`.
        step_size: Step size of the run [s].
        fmu_step: Step of the FMU itself [s], or None for ``step_size``.
        unguarded: Function that opens the vehicle without guards, for a drive that guards have
            stopped.
        held: Function of :func:`openers_held`, or None to leave out whether it stays where it
            stopped.
        progress: Function that receives the name of each drive before it begins.
    """
    report, free = CheckReport(expected), unguarded or opener
    tell = progress or (lambda _name: None)
    go_on = _drive_all(report, opener, free, tell)
    if go_on:
        tell("answers")
    _observe(report, *(_judged(report, free, held) if go_on else ()))
    if go_on:
        tell("step halving")
        # Guards would end the drives of light or stiff vehicles at the first step of any length.
        _halve(report, free, fmu_step or step_size)
    traces = report.traces
    if "response" in traces:
        report.findings.append(observe.time_per_step(traces["response"]))
    if traces:
        report.findings.append(observe.warnings(traces))
    return report


def _drive_all(
    report: CheckReport, opener: Opener, free: Opener, tell: Callable[[str], None]
) -> bool:
    """Do the drives in turn; return whether the step-halving test still makes sense."""
    for name in _DRIVES:
        tell(name)
        attempt = _attempt(name, report.expected, opener)
        error = attempt.error
        if name == "idle":
            report.findings.append(_starting(attempt))
        if error is None:
            if attempt.trace is not None:
                report.traces[name] = attempt.trace
            if name == "idle":
                tell("model")
                error = _identify(report, free)
                # A run allows for the lag; the guards of a profile without a [model] do not.
                opener = free if report.filtered else opener
            if error is None:
                continue
            attempt = Attempt(attempt.trace, error)
        if attempt.trace is not None or name != "idle":
            report.findings.append(Finding(_NAMES[name], "fail", plain(error)))
        if name == "response" and isinstance(error, FmuOutputError):
            seen = _attempt("response", report.expected, free)  # a guard has stopped it
            if seen.error is None and seen.trace is not None:
                report.traces["response"] = seen.trace
        if name != "rolling" or isinstance(error, FmuCrashError):
            # Too coarse steps may cause a failing output or step, which halving them shows.
            may_diverge = isinstance(error, FmuOutputError | FmuStepError)
            return may_diverge and not isinstance(error, FmuCrashError)
    return True


def _identify(report: CheckReport, free: Opener) -> FmuCrashError | None:
    """Identify a vehicle coarsely, as a run does; return the error if its process died."""
    expected, step = report.expected, report.traces["idle"].step_size
    try:
        model = coarse(free, path=Path(), profile=expected.profile)
    except FmuCrashError as error:
        return error
    except FmuError:
        return None  # the judgement says how it answers
    report.filtered = model.sensor_lag > 0.0
    report.findings.append(observe.described(model, expected, step))
    report.expected = expected.with_model(model, right=is_vehicle(model))
    return None


def _attempt(name: str, expected: Expected, opener: Opener) -> Attempt:
    speed = expected.start_speed if name == "rolling" else 0.0
    return try_to_drive((speed,), opener, _phases(name, expected))[0]


def _starting(attempt: Attempt) -> Finding:
    if attempt.trace is None and attempt.error is not None:
        return Finding("starts", "fail", plain(attempt.error))
    return Finding("starts", "pass", "at rest, at time 0")


def _phases(name: str, expected: Expected) -> list[Phase]:
    force = expected.force
    return {
        "idle": [Phase(0.0, 2.0)],
        "response": [Phase(force, DRIVE), Phase(0.0, COAST), Phase(-force, BRAKE)],
        "again": [Phase(force, DRIVE), Phase(0.0, COAST), Phase(-force, BRAKE)],
        "rolling": [Phase(0.0, 2.0), Phase(-force, BRAKE)],
    }[name]


def _judged(
    report: CheckReport, opener: Opener, held: Callable[[float], Opener] | None
) -> list[Finding]:
    """Judge driving, braking, mass and standing as a run does."""
    expected = report.expected
    try:
        answers = measure(opener, brake_force=expected.brake_force)
    except FmuError:
        return []  # a drive before has found it, or halved steps will
    findings = judge(answers, expected.told, expected.profile)
    if held is None or any(finding.verdict == "fail" for finding in findings):
        return findings
    try:
        found = standing(opener, held, expected.profile, answers, expected.told)
    except FmuError as error:
        return [*findings, Finding(NAME, "fail", plain(error))]
    return [*findings, stays(found, expected.profile)]


def _halve(report: CheckReport, opener: Opener, fmu_step: float) -> None:
    expected, name = report.expected, "step halving"
    start_speed = expected.start_speed if "rolling" in report.traces else 0.0
    try:
        result = convergence(opener, fmu_step, force=expected.force, start_speed=start_speed)
    except FmuError as error:
        if report.passed:  # otherwise a finding reports it already
            report.findings.append(Finding(name, "fail", plain(error)))
        return
    report.convergence = result
    if result.problem:
        found = Finding(name, "fail", result.problem, remedy(result))
    elif result.finer is None:
        found = Finding(name, "skip", f"the FMU does steps of {milliseconds(result.step)} only")
    else:
        pair = f"{milliseconds(result.step)} and {milliseconds(result.finer)}"
        found = Finding(name, "pass", f"steps of {pair} give the same drive")
    report.findings.append(found)


def _observe(report: CheckReport, *judged: Finding) -> None:
    """Run every test whose drives have succeeded."""
    traces, expected, add = report.traces, report.expected, report.findings.append
    response, rolling = traces.get("response"), traces.get("rolling")
    if "idle" in traces:
        add(observe.idles(traces["idle"]))
    if rolling is not None:
        add(observe.start_speed(rolling, expected))
    if response is not None and "again" in traces:
        add(observe.reproducible(response, traces["again"]))
    report.findings.extend(judged)
    if response is None or (judged and judged[0].verdict == "fail"):
        return
    add(observe.coasts(response))
    if rolling is not None:
        add(observe.holds(rolling, roles_of(expected.profile)[1]))
    add(observe.position_follows_speed(response, expected))
    add(observe.acceleration_follows_speed(response, expected))
