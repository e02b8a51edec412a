"""Drivers to compare with."""
