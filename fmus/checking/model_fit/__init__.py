"""The longitudinal model fitted to the drives of a vehicle FMU."""
