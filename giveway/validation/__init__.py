"""The validation of the pedestrian model with recorded tracks: ADE, FDE, contacts."""

from giveway.recordings.dataset import CITR, DUT, Dataset, dataset_of
from giveway.validation.clips import Clip, read_clip, read_clips
from giveway.validation.protocol import Protocol
from giveway.validation.validating import Validation, validate

__all__ = [
    "CITR",
    "DUT",
    "Clip",
    "Dataset",
    "Protocol",
    "Validation",
    "dataset_of",
    "read_clip",
    "read_clips",
    "validate",
]
