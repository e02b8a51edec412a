"""The interface of a vehicle for the other packages. It does not depend on its FMU's process."""
