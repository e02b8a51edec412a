"""What an ego perceives: sensors, and what is in front on its path."""
