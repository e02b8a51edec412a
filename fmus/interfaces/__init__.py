"""What the floors above may expect of a vehicle, wherever its FMU runs."""
