"""The forces between pedestrians: of one pair, of all pairs of a small crowd, by a cell list."""
