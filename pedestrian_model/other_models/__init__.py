"""Pedestrian models other than VCI, and the prediction by any model, step by step."""
