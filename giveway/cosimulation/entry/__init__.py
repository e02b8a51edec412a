"""How egos enter the road."""
