"""Which variables play the vehicle's parts, and the preparation before anything native runs."""
