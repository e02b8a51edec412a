"""The interface of a vehicle to the floors above, wherever its FMU runs."""
