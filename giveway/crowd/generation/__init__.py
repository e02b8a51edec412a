"""How people are generated: places, groups, kinds, flows, encounters."""
