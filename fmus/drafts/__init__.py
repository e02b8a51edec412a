"""A draft of a vehicle profile, from what an FMU says about itself."""
