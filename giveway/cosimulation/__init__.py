"""The master: the parts of a run put together, and one control step after the other."""
