"""The controller as an FMU of C code, for other co-simulation masters."""
