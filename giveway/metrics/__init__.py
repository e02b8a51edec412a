"""The interactions of ego and pedestrians, in the numbers that traffic engineers use."""

from giveway.metrics.anticipation import Anticipation, anticipation
from giveway.metrics.conflicts import (
    CRITICAL_TTC,
    Critical,
    Proximity,
    critical_encounters,
    proximity,
)
from giveway.metrics.contacts import FRONTAL, NO_CONTACT, SIDE, contacts
from giveway.metrics.delays import (
    DELAY_FIELDS,
    DELAY_SUMMARY_FIELDS,
    Delays,
    DelaySummary,
    delays,
    gave_way,
    summarise_delays,
)
from giveway.metrics.encroachment import EGO, encroachment
from giveway.metrics.pedestrians import (
    PEDESTRIAN_FIELDS,
    WALK_SUMMARY_FIELDS,
    WalkSummary,
    pedestrian_metrics,
    summarise_walks,
    walks_without_ego,
)
from giveway.metrics.severity import SEVERITIES, SEVERITY_FIELDS, severities
from giveway.metrics.standing import stops, waiting_times
from giveway.metrics.summary import SUMMARY_FIELDS, DriveSetting, Summary, summarise
from giveway.metrics.vehicles import VehicleContact, vehicle_contacts

__all__ = [
    "CRITICAL_TTC",
    "DELAY_FIELDS",
    "DELAY_SUMMARY_FIELDS",
    "EGO",
    "FRONTAL",
    "NO_CONTACT",
    "PEDESTRIAN_FIELDS",
    "SEVERITIES",
    "SEVERITY_FIELDS",
    "SIDE",
    "SUMMARY_FIELDS",
    "WALK_SUMMARY_FIELDS",
    "Anticipation",
    "Critical",
    "DelaySummary",
    "Delays",
    "DriveSetting",
    "Proximity",
    "Summary",
    "VehicleContact",
    "WalkSummary",
    "anticipation",
    "contacts",
    "critical_encounters",
    "delays",
    "encroachment",
    "gave_way",
    "pedestrian_metrics",
    "proximity",
    "severities",
    "stops",
    "summarise",
    "summarise_delays",
    "summarise_walks",
    "vehicle_contacts",
    "waiting_times",
    "walks_without_ego",
]
