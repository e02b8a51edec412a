"""The vehicle-crowd interaction (VCI) model: its forces, its step and its prediction."""
