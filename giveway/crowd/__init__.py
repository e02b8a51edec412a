"""The crowd of a run: how pedestrians are drawn, taken over, handed back, disturbed and seen."""
