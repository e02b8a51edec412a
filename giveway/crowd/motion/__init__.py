"""The disturbances and attractions on top of a pedestrian model."""
