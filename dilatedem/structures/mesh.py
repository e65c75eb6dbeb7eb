"""A structure drawn in another program: an STL or OBJ file, as convex pieces with rounded edges."""

from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
import shapely
from pydantic import model_validator

from dilatedem.field.obstacles import Obstacle
from dilatedem.geometry.half_spaces import between
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.keys import (
    Digest,
    Fault,
    File,
    Friction,
    Name,
    PoissonRatio,
    Positive,
    Vector3,
    complete,
    content_faults,
    content_of,
    digest_key,
    key,
)
from dilatedem.numerics.frames import matrix_from_quaternion, quaternion_from_rotation_vector
from dilatedem.numerics.plain import turned
from dilatedem.state.charts import Along
from dilatedem.structures import solid
from dilatedem.structures.kind import Chart, Part, Sketch, Structure, friction_key, modulus_key, name_key, ratio_key
from dilatedem.structures.support import AnySupport, support_key
from dilatedem.structures.surface import Pieces, pieces_of

SUFFIXES = (".stl", ".obj")


class Mesh(Structure):
    """A structure from a closed surface mesh of one or more connected pieces. Those that are not convex are split into some that
    are, by CoACD (`pip install 'dilatedem[mesh]'`); `dilatedem check` says what came out. Edges are rounded within the surface."""

    kind: Literal["mesh"] = key(..., "", "A structure from an STL or OBJ file.")
    name: Name = name_key("mesh")
    file: File = key(..., "", "STL or OBJ file; a relative path starts at the folder of the case file.")
    sha256: Digest | None = digest_key()
    scale: Positive = key(1.0, "", "Metres per unit of the file: 0.001 for millimetres.")
    position: Vector3 = key(
        (0.0, 0.0, 0.0), "m", "Where the origin of the file's coordinates comes to; moments are about it, at z = 0."
    )
    rotation: Vector3 = key(
        (0.0, 0.0, 0.0), "rad", "Rotation vector about that origin: its direction is the axis, its length the angle."
    )
    dilated_radius: Positive = key(0.1, "m", "Radius by which edges and corners are rounded.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    def faults(self) -> list[Fault]:
        if Path(self.file).suffix.lower() not in SUFFIXES:
            return [(("file",), "must be an STL or OBJ file, by its name, too: .stl or .obj")]
        return content_faults(self.file, self.sha256)

    @model_validator(mode="after")
    def _note_content(self):
        if self.sha256 is None:
            complete(self, "sha256", content_of(self.file))
        return self

    @cached_property
    def _drawn(self) -> Pieces:
        """As in the file."""
        try:
            return pieces_of(self.file, self.sha256)
        except ValueError as fault:
            raise ValueError(f"{Path(self.file).name} {fault}") from fault

    def _solids(self) -> list[Polyhedron]:
        """In place, with sharp edges."""
        turn = matrix_from_quaternion(quaternion_from_rotation_vector(self.rotation))
        pieces = [piece.scaled(self.scale) for piece in self._drawn.solids]
        return [
            Polyhedron(turned(turn, piece.vertices) + self.position, piece.edges, piece.faces, turned(turn, piece.normals))
            for piece in pieces
        ]

    def remarks(self) -> list[str]:
        found, cubed = self._drawn, self.scale**3
        surfaces = f"{found.surfaces} closed surface{'s' * (found.surfaces > 1)} of {found.enclosed * cubed:.5g} m3"
        if not found.split:
            return [f"{surfaces}, {'all' if found.surfaces > 1 else 'it is'} convex"]
        change = 100.0 * (found.volume / found.enclosed - 1.0)
        pieces = f"{len(found.solids)} convex pieces of {found.volume * cubed:.5g} m3 ({change:+.2g} %)"
        return [f"{surfaces}, {found.split} not convex: taken as {pieces}"]

    @property
    def place(self) -> np.ndarray:
        return np.array([*self.position[:2], 0.0])

    def parts(self) -> list[Part]:
        """A dilated solid for each piece."""
        return [solid.rounded(piece, self.dilated_radius) for piece in self._solids()]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        return [obstacle for piece in self._solids() for obstacle in solid.obstacles(piece, thickness)]

    def _waterline(self) -> np.ndarray | None:
        """(k, 2) [m] around what the water level cuts out of it: of one area all around, of several their hull; None of none."""
        cuts = [between(piece, 0.0, 0.0) for piece in self._solids()]
        cuts = [points for points in cuts if len(points) > 2]
        if not cuts:
            return None
        areas = shapely.union_all([shapely.Polygon(solid.hull_in_plan(points)) for points in cuts])
        if areas.geom_type != "Polygon":
            return solid.hull_in_plan(np.concatenate(cuts))
        return shapely.get_coordinates(shapely.orient_polygons(areas).exterior)[:-1]

    def chart(self, extent: float) -> Chart:
        around = self._waterline()
        if around is None:
            around = solid.hull_in_plan(np.concatenate([piece.vertices for piece in self._solids()]))
        zero = "distance around the structure's waterline, counter-clockwise seen from above, from the first corner of outline_m"
        return Chart(Along.OUTLINE, "Distance around the waterline", zero, outline=around - self.place[:2])

    def drawing(self, extent: float) -> list[Polyhedron]:
        return self._solids()

    def sketch(self, extent: float) -> Sketch | None:
        around = self._waterline()
        return None if around is None else Sketch(around)
