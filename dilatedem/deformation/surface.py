"""The surface of a body that bends: where its corners are, and how they are stressed."""

import numpy as np

from dilatedem.deformation.bent import Bent
from dilatedem.deformation.mesh import Mesh
from dilatedem.deformation.stress import tension, von_mises


class Surface:
    """The surface of a body's mesh: its corners and what each mode does there."""

    def __init__(self, body: Bent):
        modes = body.modes
        surface = Mesh(modes.nodes, modes.elements[:, :4]).surface()
        corner, self.triangles = np.unique(surface, return_inverse=True)
        self.triangles = self.triangles.reshape(surface.shape)
        self._points, self._shape, self._stress = modes.nodes[corner], modes.shape[:, corner], modes.stress[:, corner]

    def bent(self, out: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Places (c, 3) and displacements (c, 3) [m] in the body's frame, von Mises' stress (c,) and tension (c,) [Pa]."""
        moved, stress = np.zeros_like(self._points), np.zeros((len(self._points), 6))
        for own, shape, unit in zip(out, self._shape, self._stress, strict=False):  # in a fixed order
            moved, stress = moved + own * shape, stress + own * unit
        return self._points + moved, moved, von_mises(stress), tension(stress)
