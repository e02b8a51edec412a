"""The C sources of the shipped FMUs, how they are compiled, and the export of the controller."""
