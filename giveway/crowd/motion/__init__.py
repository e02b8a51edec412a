"""The sway of people, and attractions, on top of a pedestrian model."""
