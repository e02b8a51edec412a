"""Pedestrian models of other packages: what they implement, and how they are asked and checked."""
