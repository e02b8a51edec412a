"""The counts in the ledger of pedestrians."""

LEDGER = ("added", "taken_over", "handed_back", "arrived", "continued", "walking")
"""The counts in the ledger of pedestrians, in order."""
