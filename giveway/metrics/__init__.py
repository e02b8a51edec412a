"""What happened between ego and pedestrians, in the numbers that traffic engineers use."""

from giveway.metrics.conflicts import clearance, deceleration_to_avoid_crash, time_to_collision
from giveway.metrics.encroachment import post_encroachment_time
from giveway.metrics.pedestrians import PEDESTRIAN_FIELDS, pedestrian_metrics
from giveway.metrics.summary import (
    STOP_SPEED,
    SUMMARY_FIELDS,
    Summary,
    summarise,
    waiting_times,
)

__all__ = [
    "PEDESTRIAN_FIELDS",
    "STOP_SPEED",
    "SUMMARY_FIELDS",
    "Summary",
    "clearance",
    "deceleration_to_avoid_crash",
    "pedestrian_metrics",
    "post_encroachment_time",
    "summarise",
    "time_to_collision",
    "waiting_times",
]
