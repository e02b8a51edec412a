"""The judgement by the law of the road: an independent pass over the tables of a drive.

It does not know the ego's own reasons for giving way. Definitions are in docs/law.md.
"""

from giveway.metrics.law.drive import Drive, Undisturbed
from giveway.metrics.law.ledger import LAW_FIELDS, Event, LawSummary, Ledger, count, ledger

__all__ = ["LAW_FIELDS", "Drive", "Event", "LawSummary", "Ledger", "Undisturbed", "count", "ledger"]
