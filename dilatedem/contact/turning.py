"""Shapes turned to world directions, only for bodies that some awake pair looks at."""

from dilatedem.jit import item
from dilatedem.numerics.rotation import rotation_matrix, to_world
from dilatedem.numerics.vector import load, store


@item
def turn_shape(body, shapes, orientation, vertex, face_normal):
    """Core vertices and face normals of a body in world directions, from its centroid; written to its rows of both arrays."""
    R = rotation_matrix(orientation[body, 0], orientation[body, 1], orientation[body, 2], orientation[body, 3])
    for i in range(shapes.vertex_start[body], shapes.vertex_start[body + 1]):
        store(vertex, i, to_world(R, load(shapes.vertex, i)))
    for f in range(shapes.face_start[body], shapes.face_start[body + 1]):
        store(face_normal, f, to_world(R, load(shapes.face_normal, f)))
