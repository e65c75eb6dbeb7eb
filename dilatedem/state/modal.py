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
    ("mode_frequency", np.ndarray),  # (n, m) rad/s
    ("mode_square", np.ndarray),  # (n, m) 1/s2, its square
    ("mode_damping", np.ndarray),  # (n, m) 1/s, twice the damping ratio times the frequency
    ("mode_reach", np.ndarray),  # (n, m) 1/sqrt(kg), the largest displacement of the shape
    ("rest_inertia", np.ndarray),  # (n, 6) 1/(kg m2), inverse inertia of the unbent body: xx, yy, zz, yz, zx, xy
    ("inertia_change", np.ndarray),  # (n, m, 6) 1/(kg^1.5 m3), of that by the coordinate
    ("mode_mobility", np.ndarray),  # (n,) 1/kg, with which the modes give way at most to a push on a corner of the core
    ("swing", np.ndarray),  # (n, 8, m) how modes swing in a step as long as the last one: see `motion.modal`
    ("swing_time", np.ndarray),  # (n,) s, how long that was; 0: none yet
    ("lattice_start", np.ndarray),  # (n,)
    ("lattice_size", np.ndarray),  # (n, 3) places along each axis
    ("lattice_origin", np.ndarray),  # (n, 3) m
    ("lattice_pace", np.ndarray),  # (n, 3) 1/m, places per metre
    ("lattice", np.ndarray),  # (rows, 3) 1/sqrt(kg)
    ("face_centre", np.ndarray),  # (f, 3) m, of each face of the core, as `Shapes` has them
    ("face_shape", np.ndarray),  # (f, m, 6) how it moves [1/sqrt(kg)] and turns [1/m/sqrt(kg)] with each mode
    ("skin_face", np.ndarray),  # (n+1,) faces of each body: as in `deformation.skin.Skin`, one body after the other
    ("skin_normal", np.ndarray),  # (f, 3)
    ("skin_centre", np.ndarray),  # (f, 3) m
    ("skin_reach", np.ndarray),  # (f,) m
    ("skin_area", np.ndarray),  # (f,) m2
    ("skin_first", np.ndarray),  # (f, m, 3) m2/sqrt(kg)
    ("skin_outward", np.ndarray),  # (f, m) m2/sqrt(kg)
    ("skin_moment", np.ndarray),  # (f, m, 3) m3/sqrt(kg)
    ("skin_second", np.ndarray),  # (f, m, m) m2/kg
    ("skin_start", np.ndarray),  # (f+1,) points of each face
    ("skin_point", np.ndarray),  # (p, 3) m
    ("skin_weight", np.ndarray),  # (p,) m2
    ("skin_shape", np.ndarray),  # (p, m, 3) 1/sqrt(kg)
    ("stress_start", np.ndarray),  # (n+1,) points of the surface where each body's stress is looked at
    ("stress_point", np.ndarray),  # (q, 3) m
    ("stress_shape", np.ndarray),  # (q, m, 3) Pa/(m sqrt(kg)), in the plane of the surface: along two axes across each other, shear
    ("stress_bound", np.ndarray),  # (n,) Pa s/(m sqrt(kg)), what no tension is above over the root of sum w_i^2 xi_i^2
    ("strength", np.ndarray),  # (n,) Pa that the body bears in bending
])  # fmt: skip

#: `Bodies` with the coordinates of their modes
ModalBodies = NamedTuple("ModalBodies", [
    *Bodies.__annotations__.items(),
    ("coordinate", np.ndarray),  # (n, m) m sqrt(kg)
    ("rate", np.ndarray),  # (n, m) m sqrt(kg)/s
    ("middle_rate", np.ndarray),  # (n, m) mean of the last step
    ("mode_force", np.ndarray),  # (n, m) sqrt(kg) m/s2, all that acts on the mode but its own stiffness and damping
    ("mode_load", np.ndarray),  # (n, m) the same of contacts, water and wind alone
    ("mode_loss", np.ndarray),  # (n,) J that it has taken up since the start
    ("bent_load", np.ndarray),  # (n, works, m) sqrt(kg) m/s2 of each load in `water.loads.WORKS`; `work` has what they did
    ("seen_coordinate", np.ndarray),  # (n, m) m sqrt(kg), when the stress was last looked at
    ("seen_tension", np.ndarray),  # (n,) Pa, what was found
    ("peak_tension", np.ndarray),  # (n,) Pa, the largest principal stress at a point of the surface so far
    ("peak_time", np.ndarray),  # (n,) s, when that was
    ("peak_place", np.ndarray),  # (n,) of `ModalSolids.stress_point`, where
    ("failed_at", np.ndarray),  # (n,) s, when it was first above the body's strength; infinite: never
    ("failed_place", np.ndarray),  # (n, 3) m, world, where
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
    ("spline", np.ndarray),  # (threads, 27, 4) weights of the places around a point: of a field there, of half its slopes
    ("seat", np.ndarray),  # (threads, 2, 6) m: what is carried from the centroid, turned with the bent body; where it is carried to
    ("mode_push", np.ndarray),  # (pairs, 2, m) sqrt(kg) m/s2, of each contact on the modes of its bodies
    ("mode_idle", np.ndarray),  # (1, m) the same, that nobody asks for
    ("spread", np.ndarray),  # (n, m, 3) m2/sqrt(kg), integral of the modes' shapes over what a drag is spread over
])  # fmt: skip


def bending(bodies: Bodies, modes: int) -> ModalBodies:
    """The same bodies, unbent and at rest, of up to `modes` modes."""
    count = len(bodies.path)
    coordinate, rate, middle_rate, mode_force, mode_load = (np.zeros((count, modes)) for _ in range(5))
    return ModalBodies(
        *bodies, coordinate, rate, middle_rate, mode_force, mode_load,
        mode_loss=np.zeros(count),
        bent_load=np.zeros((*bodies.power.shape, modes)),
        seen_coordinate=np.zeros((count, modes)),
        seen_tension=np.zeros(count),
        peak_tension=np.zeros(count),
        peak_time=np.zeros(count),
        peak_place=np.zeros(count, np.int64),
        failed_at=np.full(count, np.inf),
        failed_place=np.zeros((count, 3)),
    )  # fmt: skip


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
        spline=np.zeros((threads, 27, 4)),
        seat=np.zeros((threads, 2, 6)),
        mode_push=np.zeros((pairs, 2, modes)),
        mode_idle=np.zeros((1, modes)),
        spread=np.zeros((bodies, modes, 3)),
    )
