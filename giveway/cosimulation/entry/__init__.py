"""The entry of egos onto the road."""
