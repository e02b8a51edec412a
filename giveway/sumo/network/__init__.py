"""The network of the running simulation: its lanes, junctions, crossings and footpaths."""
