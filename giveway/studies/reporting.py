"""The report of a study: pictures, the runs that tell most, their replays, one page."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from giveway.studies.folder import StudyFolder


def write_report_of(study: StudyFolder) -> Path:
    """Write figures, replays and ``report.html`` into the study's folder."""
    raise NotImplementedError
