"""Tests of whether an FMU behaves like a vehicle: dry runs, step halving, identification."""

from fmus.checking.answers import Answers, measure
from fmus.checking.check import CheckReport, check, expected_of
from fmus.checking.coarse import coarse, is_vehicle, quick_model
from fmus.checking.findings import Finding, Verdict
from fmus.checking.identification import Identification, Mpc, identify
from fmus.checking.judgement import Told, judge, told_of, too_weak
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
    remedy,
    require_converged,
)
from fmus.checking.standing import Standing, holding, openers_held, standing, stays

__all__ = [
    "Answers",
    "CheckReport",
    "Convergence",
    "Finding",
    "Identification",
    "Mpc",
    "Opener",
    "Phase",
    "Standing",
    "Told",
    "Trace",
    "Verdict",
    "check",
    "coarse",
    "convergence",
    "drive",
    "expected_of",
    "holding",
    "identify",
    "is_vehicle",
    "judge",
    "measure",
    "opener_of",
    "openers_held",
    "quick_model",
    "remedy",
    "require_converged",
    "standing",
    "stays",
    "told_of",
    "too_weak",
    "without_guards",
]
