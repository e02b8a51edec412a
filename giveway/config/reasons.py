"""The reasons for bounds that several options share; of two, for the lower and the upper one."""

MILLIMETRE = 0.001
"""Smallest gap [m] between bodies that makes sense."""

GAP = ("no gap between bodies is smaller than a millimetre", "no street has room for it")
TYRES = ("less than 0.1 m/s^2 is not noticeable", "tyres transmit at most 10 m/s^2")
FORCE = ("a newton moves no vehicle", "1000 kN no road holds")
BUFFER = "it is a stretch of road that a vehicle drives within its sight"
