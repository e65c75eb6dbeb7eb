"""Bodies that deform by some of their modes: what they are made of, how far each mode is out, and room to work in.

Classes of their own, so that kernels know nothing of modes where no body has any.
"""

from typing import NamedTuple

import numpy as np

from dilatedem.state.bodies import Bodies, Solids
from dilatedem.state.storage import Workspace

#: `Solids` of which some bend by up to m modes of a mass of 1 kg each. `motion.modal` keeps `inverse_inertia` as it is bent.
#: The modes' shapes are fields over a lattice of each body (`deformation.lattice`): place (x, y, z) of body i has the row
#: lattice_start[i] + ((x ny + y) nz + z) mode_count[i], and the next ones for further modes.
ModalSolids = NamedTuple("ModalSolids", [
    *Solids.__annotations__.items(),
    ("mode_count", np.ndarray),  # (n,) modes of each body, the first ones of its rows
    ("mode_square", np.ndarray),  # (n, m) 1/s2, squared frequency
    ("mode_damping", np.ndarray),  # (n, m) 1/s, twice the damping ratio times the frequency
    ("mode_reach", np.ndarray),  # (n, m) 1/sqrt(kg), the largest displacement of the shape
    ("inertia_gradient", np.ndarray),  # (n, m, 3, 3) m sqrt(kg), of the inertia by the coordinate
    ("lattice_start", np.ndarray),  # (n,)
    ("lattice_size", np.ndarray),  # (n, 3) places along each axis
    ("lattice_origin", np.ndarray),  # (n, 3) m
    ("lattice_pace", np.ndarray),  # (n, 3) 1/m, places per metre
    ("lattice", np.ndarray),  # (rows, 3) 1/sqrt(kg)
])  # fmt: skip

#: `Bodies` with the coordinates of their modes
ModalBodies = NamedTuple("ModalBodies", [
    *Bodies.__annotations__.items(),
    ("coordinate", np.ndarray),  # (n, m) m sqrt(kg)
    ("rate", np.ndarray),  # (n, m) m sqrt(kg)/s
    ("middle_rate", np.ndarray),  # (n, m) half a step ago
    ("mode_force", np.ndarray),  # (n, m) sqrt(kg) m/s2, all that acts on the mode: its acceleration
    ("mode_load", np.ndarray),  # (n, m) the same of contacts alone
    ("mode_power", np.ndarray),  # (n,) W that the damping of modes takes up
    ("mode_loss", np.ndarray),  # (n,) J that it has taken up since the start
])  # fmt: skip

#: `Workspace` with what each thread needs to meet bodies as they are bent where they touch (`contact.tangent`)
ModalWorkspace = NamedTuple("ModalWorkspace", [
    *Workspace.__annotations__.items(),
    ("bent_vertex", np.ndarray),  # (threads, v, 3)
    ("bent_face_normal", np.ndarray),  # (threads, f, 3)
    ("bent_position", np.ndarray),  # (threads, n, 3) and so on as in `Bodies`
    ("bent_orientation", np.ndarray),  # (threads, n, 4)
    ("bent_velocity", np.ndarray),  # (threads, n, 3)
    ("bent_spin", np.ndarray),  # (threads, n, 3)
    ("bent_middle_velocity", np.ndarray),  # (threads, n, 3)
    ("bent_middle_spin", np.ndarray),  # (threads, n, 3)
    ("shape", np.ndarray),  # (threads, 2, m, 6) of the modes of a pair's bodies: displacement [1/sqrt(kg)], turning [1/m/sqrt(kg)]
    ("seat", np.ndarray),  # (threads, 2, 6) m: what is carried from the centroid, turned with the bent body; where it is carried to
    ("mode_push", np.ndarray),  # (pairs, 2, m) sqrt(kg) m/s2, of each contact on the modes of its bodies
])  # fmt: skip


def bending(bodies: Bodies, modes: int) -> ModalBodies:
    """The same bodies, unbent and at rest, of up to `modes` modes."""
    count = len(bodies.path)
    return ModalBodies(*bodies, *(np.zeros((count, modes)) for _ in range(5)), np.zeros(count), np.zeros(count))


def bending_room(workspace: Workspace, threads: int, bodies: int, pairs: int, modes: int) -> ModalWorkspace:
    """The same room, and that for bodies which bend."""
    return ModalWorkspace(
        *workspace,
        bent_vertex=np.zeros((threads, *workspace.vertex.shape)),
        bent_face_normal=np.zeros((threads, *workspace.face_normal.shape)),
        bent_position=np.zeros((threads, bodies, 3)),
        bent_orientation=np.zeros((threads, bodies, 4)),
        bent_velocity=np.zeros((threads, bodies, 3)),
        bent_spin=np.zeros((threads, bodies, 3)),
        bent_middle_velocity=np.zeros((threads, bodies, 3)),
        bent_middle_spin=np.zeros((threads, bodies, 3)),
        shape=np.zeros((threads, 2, modes, 6)),
        seat=np.zeros((threads, 2, 6)),
        mode_push=np.zeros((pairs, 2, modes)),
    )
