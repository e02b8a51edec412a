"""Replays: one page that plays a run, in any browser and without a network."""
