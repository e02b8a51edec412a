"""How background vehicles, egos and people interact."""
