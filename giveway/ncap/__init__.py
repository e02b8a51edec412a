"""Consumer tests with people: a car's FMU in the scripted tests of a protocol, and their table."""
