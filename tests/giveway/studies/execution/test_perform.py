"""A task is performed: settings survive the way to a worker."""

from __future__ import annotations

from giveway.journal.journal import Journal
from giveway.processes.heartbeat import Phase
from giveway.studies.execution.perform import perform
from giveway.studies.plan import plan


def test_a_task_survives_json(small_study):
    """What a worker reads is what was planned, down to the last bit."""
    planned = plan(small_study.definition, "s")
    run = next(planned.runs(planned.seeds))
    from giveway.config import RunConfig

    assert RunConfig.model_validate_json(run.task().config) == run.config
    journal = Journal(None)
    record = perform(run.task(), journal)
    assert journal.heartbeat.read().phase is Phase.MEASURING  # the last thing that may crash
    kept = small_study.record("c1-s1")
    assert kept is not None
    assert repr(record.rows) == repr(kept.rows)
