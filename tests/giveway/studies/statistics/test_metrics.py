"""What is compared: numbers of the summary, each with its unit and its better side."""

import pytest

from giveway.errors import ConfigError
from giveway.metrics import DELAY_SUMMARY_FIELDS, SUMMARY_FIELDS
from giveway.metrics.law import LAW_FIELDS
from giveway.studies.statistics import METRICS, metric

UNITS = {
    column.name: column.unit or ""
    for column in (*SUMMARY_FIELDS, *LAW_FIELDS, *DELAY_SUMMARY_FIELDS)
}


@pytest.mark.parametrize("each", METRICS, ids=lambda each: each.name)
def test_every_metric_is_a_column_of_the_summary_with_its_unit(each) -> None:
    assert UNITS[each.name] == each.unit
    assert metric(each.name) is each


def test_what_is_left_out_says_nothing_about_a_controller() -> None:
    left = set(UNITS) - {each.name for each in METRICS}
    said = {"completed", "simulated_time", "travelled_distance", "maximum_speed"}
    said |= {"vehicle_contacts", "vehicle_contact_time"}  # SUMO drives those into it
    said |= {"encounters", "people_delayed"}  # how many people come is not up to it
    said |= {"people_near", "people_near_moving"}  # nor this
    said |= {"twin_differs"}  # says how much the delays mean
    said |= {"beyond_assumption", "contacts_beyond"}  # what the simulated people do
    said |= {"slowed"}  # people do; which runs count, see the situations
    assert left == said | {"hard_brakes", "hard_brakes_without_cause"}  # of drives in traffic


def test_a_name_without_any_likeness_lists_them_all(refused) -> None:
    with refused(ConfigError, "colour", "completion_time, longest_wait"):
        metric("colour")
