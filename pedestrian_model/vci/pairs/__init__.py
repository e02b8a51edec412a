"""The forces between pedestrians: one pair, all pairs of a small crowd, and by a cell list."""
