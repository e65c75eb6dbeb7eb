"""How a convex body vibrates and bends: a mesh of its outer shape, its free modes, stress from them and from loads.

Modes come from LAPACK and ARPACK, whose last digits differ from processor to processor: what is computed here is the same on one
machine, and within its tolerances on all.
"""
