"""The roles of an FMU's variables, and all preparation before native code runs."""
