"""Loads on a floating body: gravity, buoyancy with its righting moment, drag of the current (Liu 2015, section 3.2)."""

from dilatedem.jit import item
from dilatedem.numerics.rotation import rotation_matrix, to_world
from dilatedem.numerics.vector import add, along, cross, dot, load, norm, scale, sub


@item
def body_loads(i, hulls, solids, surroundings, bodies, wet):
    """Force [N] and torque about the centroid [N m] on body i, and the power of the drag [W].

    wet (n, 5): see `water.floating.submerge`; not read where there is no water.
    """
    weight = -solids.mass[i] * surroundings.gravity
    volume = wet[i, 0] if surroundings.water else 0.0
    if volume == 0.0:
        return (0.0, 0.0, weight), (0.0, 0.0, 0.0), 0.0
    density, wetted = surroundings.water_density, wet[i, 4]
    lift = density * surroundings.gravity * volume
    q = bodies.orientation
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    righting = cross(to_world(R, (wet[i, 1], wet[i, 2], wet[i, 3])), (0.0, 0.0, lift))  # Eq. (25)
    v = load(bodies.velocity, i)
    u = sub(v, (surroundings.current_x, surroundings.current_y, 0.0))
    drag = scale(-0.5 * surroundings.drag_force * density * wetted * norm(u), u)  # Eq. (26)
    w = load(bodies.angular_velocity, i)
    size = hulls.effective_radius[i]
    brake = scale(-0.5 * surroundings.drag_moment * size**3 * density * wetted * norm(w), w)  # Eq. (27)
    power = dot(drag, v) + dot(brake, w)
    return along(drag, 1.0, (0.0, 0.0, weight + lift)), add(righting, brake), power
