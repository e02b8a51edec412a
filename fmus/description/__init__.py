"""The contents of an FMU's description: its variables, units, interfaces and binaries."""
