"""The report of a study: pictures, tables and words in one HTML file.

Importing this imports matplotlib and jinja2; the command line does so late.
"""

from giveway.reports.choice import ExamplePair, WorstRun, example_pairs, worst_runs
from giveway.reports.page import shown_runs, write_report

__all__ = [
    "ExamplePair",
    "WorstRun",
    "example_pairs",
    "shown_runs",
    "worst_runs",
    "write_report",
]
