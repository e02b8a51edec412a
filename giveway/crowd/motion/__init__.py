"""What disturbs or guides how people walk."""
