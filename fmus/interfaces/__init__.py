"""What other floors may expect of a vehicle and of an FMU's instance."""
