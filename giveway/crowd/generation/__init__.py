"""The generation of people: places, groups, kinds, flows and encounters."""
