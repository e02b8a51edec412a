"""Tests of whether an FMU behaves like a vehicle: dry runs, step halving, identification."""

from fmus.checking.check import CheckReport, check, expected_of
from fmus.checking.coarse import coarse
from fmus.checking.findings import Finding, Verdict
from fmus.checking.identification import Identification, Mpc, identify
from fmus.checking.manoeuvres import (
    Opener,
    Phase,
    Trace,
    drive,
    opener_of,
    without_guards,
)
from fmus.checking.self_check import (
    Convergence,
    convergence,
    goes_the_wrong_way,
    remedy,
    require_converged,
)

__all__ = [
    "CheckReport",
    "Convergence",
    "Finding",
    "Identification",
    "Mpc",
    "Opener",
    "Phase",
    "Trace",
    "Verdict",
    "check",
    "coarse",
    "convergence",
    "drive",
    "expected_of",
    "goes_the_wrong_way",
    "identify",
    "opener_of",
    "remedy",
    "require_converged",
    "without_guards",
]
