"""Which variables play the vehicle's roles, and all preparation before native code runs."""
