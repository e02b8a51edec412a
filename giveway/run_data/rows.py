"""The speed below which an ego stands, and the counts in the ledger of pedestrians."""

STOP_SPEED = 0.2
"""Speed [m/s] below which the ego stands; Yang & Özgüner 2019, section 2.1, then treat it as an
obstacle."""

LEDGER = ("added", "taken_over", "handed_back", "arrived", "continued", "walking")
"""The counts in the ledger of pedestrians, in order."""
