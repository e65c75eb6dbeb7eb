"""Oracle of the stacks: every floe by itself, then every vertex, face and edge by itself in plain loops."""

import numpy as np

from dilatedem.geometry import outline as plan
from dilatedem.geometry.polyhedron import prism
from dilatedem.geometry.shapes import BodyShape


def shapes_one_by_one(outlines, thickness, radius):
    """A BodyShape and its centroid (3,) for every outline (k, 2)."""
    half = 0.5 * thickness - radius
    return [BodyShape.of_core(prism(plan.erode(outline, radius), -half, half), radius) for outline in outlines]


def packed_one_by_one(polyhedra):
    """Flat arrays of single polyhedra in their order, by the names of `Shapes`."""
    packed = {name: [] for name in ("vertex", "face_normal", "loop", "neighbour")}
    starts = {name: [0] for name in ("vertex_start", "face_start", "loop_start", "neighbour_start")}
    for body in polyhedra:
        first = len(packed["vertex"])
        packed["vertex"] += list(body.vertices)
        packed["face_normal"] += list(body.normals)
        for face in body.faces:
            packed["loop"] += [first + corner for corner in face]
            starts["loop_start"].append(len(packed["loop"]))
        for vertex in range(len(body.vertices)):
            near = [i + j - vertex for i, j in body.edges if vertex in (i, j)]
            packed["neighbour"] += [first + other for other in near]
            starts["neighbour_start"].append(len(packed["neighbour"]))
        starts["vertex_start"].append(len(packed["vertex"]))
        starts["face_start"].append(len(packed["face_normal"]))
    return {name: np.array(values) for name, values in (packed | starts).items()}
