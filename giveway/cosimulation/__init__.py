"""The master of the co-simulation: it puts the parts of a run together and steps them."""
