"""What other programs take for the same scenes: coal, timed here and now, and published figures of complete codes.

coal (the collision library of Pinocchio, C++) answers the geometric questions of a step: a distance for each pair of floes whose
bounding boxes overlap, and a collision for each contact. It is called from Python; what a call takes on two spheres, where there
is nothing to compute, is taken off.
"""

import time

import numpy as np

from dilatedem.numerics.frames import matrix_from_quaternion

#: ms a step at 200 floes, one thread, dt = 1e-4 s: drift, jam, packed; taken on the same kind of machine, on another day
PUBLISHED = {
    "YADE 2023, polyhedra": (5.7, 10.4, 84.0),
    "LAMMPS, rounded polyhedra": (37.0, 37.0, 57.0),
    "MechSys, spheropolyhedra": (0.105, 0.19, 3.3),
    "exaDEM 1.2, polyhedra": (0.054, 0.076, 0.82),
    "Bullet (constraint solver)": (0.21, 0.31, 9.2),
    "MuJoCo (constraint solver)": (0.17, 0.37, 6.9),
    "LIGGGHTS, spheres": (0.0025, None, 0.024),
    "coal 3.0 (geometry only)": (0.10, 0.13, 0.50),
}


def load_coal():
    """The package, or None where it is not installed."""
    try:
        import coal
    except ImportError:
        return None
    return coal


def near_pairs(simulation) -> np.ndarray:
    """Pairs of floes (n, 2) whose bounding boxes, dilation included, overlap now and that are not both held fast."""
    shapes, bodies, floating = simulation.model.shapes, simulation.state.bodies, simulation.model.floating
    low, high = np.zeros((floating, 3)), np.zeros((floating, 3))
    for i in range(floating):
        corners = shapes.vertex[shapes.vertex_start[i] : shapes.vertex_start[i + 1]]
        corners = corners @ matrix_from_quaternion(bodies.orientation[i]).T + bodies.position[i]
        low[i], high[i] = corners.min(axis=0) - shapes.radius[i], corners.max(axis=0) + shapes.radius[i]
    apart = np.any((low[:, None] > high[None]) | (low[None] > high[:, None]), axis=2)
    moves = simulation.model.solids.inverse_mass[:floating] > 0.0
    return np.argwhere(np.triu(~apart & (moves[:, None] | moves[None]), k=1))


def _contacts(simulation) -> np.ndarray:
    """Pairs of floes (n, 2) in contact."""
    pairs = simulation.state.pairs
    count = int(pairs.count[0])
    both = np.column_stack([pairs.a[:count], pairs.b[:count]])
    return both[(pairs.overlap[:count] > 0.0) & (both[:, 1] < simulation.model.floating)]


def _hulls(coal, simulation) -> list:
    """coal's convex polyhedra of all floes' cores."""
    hulls = []
    for shape in simulation.scene.shapes:
        points = coal.StdVec_Vec3s()
        points.extend(list(shape.core.vertices))
        hulls.append(coal.Convex.convexHull(points, False, "Qt"))
    return hulls


def _questions(coal, simulation, radius: float):
    """Calls for every near pair (distance) and contact (collision): functions of no arguments that ask all of them once."""
    hulls, bodies = _hulls(coal, simulation), simulation.state.bodies
    spheres = [coal.Sphere(0.1)] * len(hulls)
    places = [
        coal.Transform3s(matrix_from_quaternion(q), p)
        for q, p in zip(bodies.orientation[: len(hulls)], bodies.position[: len(hulls)], strict=True)
    ]
    near, touching = near_pairs(simulation).tolist(), _contacts(simulation).tolist()
    wanted, hit = coal.DistanceRequest(), coal.CollisionRequest()
    hit.security_margin = 2.0 * radius
    distance_result, hit_result = coal.DistanceResult(), coal.CollisionResult()

    def ask(shapes):
        for a, b in near:
            distance_result.clear()
            coal.distance(shapes[a], places[a], shapes[b], places[b], wanted, distance_result)
        for a, b in touching:
            hit_result.clear()
            coal.collide(shapes[a], places[a], shapes[b], places[b], hit, hit_result)

    return (lambda: ask(hulls)), (lambda: ask(spheres)), len(near), len(touching)


def _best_ms(question, repeats: int) -> float:
    best = float("inf")
    for _ in range(repeats):
        began = time.perf_counter()
        question()
        best = min(best, time.perf_counter() - began)
    return 1e3 * best


def coal_step(simulation, *, repeats: int = 30) -> dict[str, float] | None:
    """coal on a simulation's present state: ms a step, with and without the calls from Python, pairs and contacts asked for.

    None where coal is not installed.
    """
    coal = load_coal()
    if coal is None:
        return None
    on_floes, on_spheres, near, touching = _questions(coal, simulation, simulation.case.ice.dilated_radius)
    called = _best_ms(on_floes, repeats)
    calls = _best_ms(on_spheres, repeats)
    return {"coal_ms": called - calls, "coal_called_ms": called, "near_pairs": near, "coal_contacts": touching}
