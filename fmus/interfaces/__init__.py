"""The interface of a vehicle for the other packages, in whatever process its FMU runs."""
