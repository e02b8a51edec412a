"""The profiles of controller FMUs: drafting, preparing and fitting them to the FMU."""
