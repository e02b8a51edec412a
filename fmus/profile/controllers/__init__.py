"""Profiles of controller FMUs: drafted, prepared and fitted to the FMU."""
