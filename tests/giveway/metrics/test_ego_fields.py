"""The columns that an ego's summary can have are told apart by their names."""

from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.run_data.columns import SUMMARY_HEAD


def test_no_two_columns_have_one_name() -> None:
    names = [column.name for column in (*SUMMARY_HEAD, *EGO_FIELDS)]
    assert len(set(names)) == len(names)
    assert {"control_delay", "sumo_time", "people_delay", "encounters"} <= set(names)
