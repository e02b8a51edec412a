"""A run in other people's formats: for SUMO, PedPy, JuPedSim, maps and films."""
