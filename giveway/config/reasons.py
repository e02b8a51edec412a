"""The reasons for bounds that several options share."""

MILLIMETRE = 0.001
"""Smallest gap [m] between bodies that makes sense."""

GAP = "a gap between bodies is between a millimetre and what a street holds"
TYRES = "tyres transmit at most 10 m/s^2; less than 0.1 m/s^2 is not noticeable"
FORCE = "a newton moves no vehicle, 1000 kN no road holds"
BUFFER = "it is a stretch of road that a vehicle drives within its sight"
