"""Controllers of other people."""
