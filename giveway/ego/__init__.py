"""One vehicle that we drive: its FMU, its controller, what it sees and what it decides."""
