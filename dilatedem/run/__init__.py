"""A simulation on its way through time: the composition root, the loop, and what is written on the way."""
