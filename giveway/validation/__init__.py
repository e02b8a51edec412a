"""The pedestrian model against recorded trajectories: ADE, FDE, contacts, calibration."""

from giveway.validation.calibrating import Calibration, calibrate
from giveway.validation.clips import Clip, read_clip, read_clips
from giveway.validation.protocol import Protocol
from giveway.validation.validating import Validation, validate

__all__ = [
    "Calibration",
    "Clip",
    "Protocol",
    "Validation",
    "calibrate",
    "read_clip",
    "read_clips",
    "validate",
]
