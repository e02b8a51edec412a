"""What keeps a study from being computed at all; a run that fails is a record, not an error."""

from __future__ import annotations

from giveway.errors import GivewayError


class WorkerError(GivewayError):
    """No process can be started or reached that would make the runs; what is finished stays."""
