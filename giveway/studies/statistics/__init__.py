"""Statistics of a study: paired differences, their intervals and tests.

docs/statistics.md describes the methods.
"""

from giveway.studies.statistics.comparing import compare
from giveway.studies.statistics.confirmatory import confirmatory, is_confirmatory
from giveway.studies.statistics.fronts import fronts
from giveway.studies.statistics.level_means import levels
from giveway.studies.statistics.metrics import METRICS, Metric, compared, metric
from giveway.studies.statistics.sequential import looks, precise_enough
from giveway.studies.statistics.situations import SITUATIONS, situations
from giveway.studies.statistics.yang2019 import PUBLISHED, table2
from giveway.studies.table_columns import (
    COMPARISON_COLUMNS,
    FRONT_COLUMNS,
    LEVEL_COLUMNS,
    PRECISION_COLUMNS,
    SITUATION_COLUMNS,
    TABLE_2_COLUMNS,
)

__all__ = [
    "COMPARISON_COLUMNS",
    "FRONT_COLUMNS",
    "LEVEL_COLUMNS",
    "METRICS",
    "PRECISION_COLUMNS",
    "PUBLISHED",
    "SITUATIONS",
    "SITUATION_COLUMNS",
    "TABLE_2_COLUMNS",
    "Metric",
    "compare",
    "compared",
    "confirmatory",
    "fronts",
    "is_confirmatory",
    "levels",
    "looks",
    "metric",
    "precise_enough",
    "situations",
    "table2",
]
