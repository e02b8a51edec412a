"""A run in other formats: for SUMO, PedPy, JuPedSim, maps and films."""
