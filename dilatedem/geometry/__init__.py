"""Shapes of bodies: cores, dilated solids, outlines in plan, packed arrays. Only geometry, nothing moves."""
