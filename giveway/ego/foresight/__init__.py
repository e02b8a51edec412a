"""The foresight of an ego: the people ahead under each of its manoeuvres."""
