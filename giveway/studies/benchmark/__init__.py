"""The benchmark: any controller in frozen scenes, beside the kept numbers of its rivals."""

from giveway.studies.benchmark.definition import (
    ALL_SCENES,
    ORIGIN,
    VERSION,
    benchmark_of,
    scenes,
)
from giveway.studies.benchmark.rivals import RECORDED, rivals
from giveway.studies.benchmark.table import COLUMNS, FILE, benchmark_table, write_benchmark
from giveway.studies.benchmark.texts import Notation, bounded, number, texts

__all__ = [
    "ALL_SCENES",
    "COLUMNS",
    "FILE",
    "ORIGIN",
    "RECORDED",
    "VERSION",
    "Notation",
    "benchmark_of",
    "benchmark_table",
    "bounded",
    "number",
    "rivals",
    "scenes",
    "texts",
    "write_benchmark",
]
