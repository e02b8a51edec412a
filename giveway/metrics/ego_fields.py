"""All columns that the summary of an ego can have, besides those of other packages' metrics."""

from giveway.metrics.baseline import BASELINE_FIELDS
from giveway.metrics.delays import DELAY_SUMMARY_FIELDS
from giveway.metrics.law import LAW_FIELDS
from giveway.metrics.summary import SUMMARY_FIELDS
from giveway.metrics.travel import TRAVEL_FIELDS

EGO_FIELDS = (
    *SUMMARY_FIELDS,
    *LAW_FIELDS,
    *TRAVEL_FIELDS,
    *DELAY_SUMMARY_FIELDS,
    *BASELINE_FIELDS,
)
