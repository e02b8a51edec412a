"""The crowd of a run: pedestrians are generated, taken over from SUMO, moved and handed back."""
