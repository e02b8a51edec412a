"""The loaded network: its lanes, junctions, crossings and footpaths."""
