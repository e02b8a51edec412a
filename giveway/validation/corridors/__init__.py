"""Recorded and simulated people in corridors with walls, compared."""
