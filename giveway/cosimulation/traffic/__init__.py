"""The interaction of background vehicles, egos and people."""
