"""What an FMU says of itself: its variables, units, interfaces and binaries."""
