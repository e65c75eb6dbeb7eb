"""The time step over lists of bodies and pairs: `advance` is the page, `blocks` the work on one part of a list."""
