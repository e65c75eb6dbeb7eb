"""Who may touch whom, and how far apart they are: the list of pairs, and the closest points of two cores.

`neighbours` makes the list from a grid of cells; `closest` is the distance algorithm, whose inner step is `simplex`, and
`penetration` takes over where cores intersect.
"""
