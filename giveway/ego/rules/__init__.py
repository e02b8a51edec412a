"""The rules of the road: each demands where the ego stops and how fast it drives."""
