"""The speed at which an ego counts as standing, and what the ledger of pedestrians counts."""

STOP_SPEED = 0.2
"""[m/s] Below it the ego stands: Yang & Özgüner 2019, section 2.1, treat it as an obstacle then."""

LEDGER = ("added", "taken_over", "handed_back", "arrived", "continued", "walking")
"""What the ledger of pedestrians counts, in order."""
