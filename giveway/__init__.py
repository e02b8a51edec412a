"""giveway: how should a vehicle drive through a crowd, and what happens to both?"""
