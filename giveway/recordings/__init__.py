"""Recordings of people and vehicles: readers by description, defects, measures of drives."""

from giveway.recordings.dataset import CITR, DUT, KNOWN, Dataset, dataset_of
from giveway.recordings.reading import read_recording, read_recordings
from giveway.recordings.recording import Defect, Recording, Tracks

__all__ = [
    "CITR",
    "DUT",
    "KNOWN",
    "Dataset",
    "Defect",
    "Recording",
    "Tracks",
    "dataset_of",
    "read_recording",
    "read_recordings",
]
