"""The persons of the scenario: taken over from SUMO and handed back to it."""
