"""How an ego kept to the law of the road: an independent pass over the tables of a drive.

Nothing here knows what the ego took for a reason to give way; see docs/law.md for definitions.
"""

from giveway.metrics.law.drive import Drive, Undisturbed
from giveway.metrics.law.ledger import LAW_FIELDS, Event, LawSummary, Ledger, count, ledger

__all__ = ["LAW_FIELDS", "Drive", "Event", "LawSummary", "Ledger", "Undisturbed", "count", "ledger"]
