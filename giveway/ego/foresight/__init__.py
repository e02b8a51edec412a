"""What an ego expects of the people ahead under each of its manoeuvres."""
