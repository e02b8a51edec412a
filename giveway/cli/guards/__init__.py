"""What is checked, or kept in a process of its own, before a command trusts a file."""
