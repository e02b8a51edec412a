"""Who walks: pedestrians drawn, taken over, handed back, disturbed, and as they are seen."""
