"""Submerged volume, its first moments and the wetted area of a body cut by the still water level z = 0.

Exact for the outer polyhedron at any tilt. A floe whose waterline crosses only its sides has a closed form (30 operations);
everything else is clipped face by face.
"""

from math import sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.rotation import rotation_matrix


@device
def submerged_prism(z, nx, ny, nz, plan, height, body):
    """A right prism cut by the water level through its sides only; valid False where top or bottom is cut, or all is dry or wet.

    z: height of the origin [m]; (nx, ny, nz): world's up in the body frame; plan (m, 10), height (m, 2): see `Hulls`. Returns
    valid, volume [m3], centre of buoyancy (x, y, z) in the body frame [m], wetted area [m2].
    """
    if nz <= 0.0:
        return False, 0.0, 0.0, 0.0, 0.0, 0.0
    # the waterline is the plane level + slope_x x + slope_y y of the body frame
    level, slope_x, slope_y = -z / nz, -nx / nz, -ny / nz
    swing = sqrt(slope_x * slope_x + slope_y * slope_y) * plan[body, 7]
    bottom, top = height[body, 0], height[body, 1]
    if level - swing < bottom or level + swing > top:
        return False, 0.0, 0.0, 0.0, 0.0, 0.0
    area, ixx, iyy, ixy = plan[body, 0], plan[body, 1], plan[body, 2], plan[body, 3]
    ax, ay = plan[body, 8], plan[body, 9]
    rise = slope_x * ax + slope_y * ay
    volume = area * (level - bottom) + rise
    mx = slope_x * ixx + slope_y * ixy + (level - bottom) * ax
    my = slope_x * ixy + slope_y * iyy + (level - bottom) * ay
    mz = 0.5 * (area * (level * level - bottom * bottom) + slope_x * mx + slope_y * my + (level + bottom) * rise)
    wetted = area + plan[body, 4] * (level - bottom) + slope_x * plan[body, 5] + slope_y * plan[body, 6]
    s = 1.0 / volume
    return True, volume, mx * s, my * s, mz * s, wetted


@device
def submerged_polyhedron(z, nx, ny, nz, hulls, body, works, thread):
    """Any convex polyhedron cut by the water level; arguments and results as `submerged_prism`. works (threads, h, 4): workspace.

    Cones from a point of the waterline plane: faces below water contribute, the waterline itself does not.
    """
    v0, v1 = hulls.vertex_start[body], hulls.vertex_start[body + 1]
    work = works[thread]
    lowest = 1e300
    for i in range(v0, v1):
        x, y, w = hulls.vertex[i, 0], hulls.vertex[i, 1], hulls.vertex[i, 2]
        h = z + nx * x + ny * y + nz * w
        work[i - v0, 0], work[i - v0, 1], work[i - v0, 2], work[i - v0, 3] = x, y, w, h
        lowest = min(lowest, h)
    if lowest >= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    # apex: the centroid's foot on the water level
    ox, oy, oz = -z * nx, -z * ny, -z * nz
    volume = mx = my = mz = wetted = 0.0
    for f in range(hulls.face_start[body], hulls.face_start[body + 1]):
        first, last = hulls.loop_start[f], hulls.loop_start[f + 1]
        # walk around the clipped face; triangles fan out from its first wet point
        started = False
        fx = fy = fz = px = py = pz = 0.0
        for i in range(first, last):
            a = hulls.loop[i] - v0
            b = hulls.loop[i + 1 if i + 1 < last else first] - v0
            ha, hb = work[a, 3], work[b, 3]
            for part in range(2):
                if part == 0:
                    if ha >= 0.0:
                        continue
                    qx, qy, qz = work[a, 0], work[a, 1], work[a, 2]
                else:
                    if (ha < 0.0) == (hb < 0.0):
                        continue
                    t = ha / (ha - hb)
                    qx = work[a, 0] + t * (work[b, 0] - work[a, 0])
                    qy = work[a, 1] + t * (work[b, 1] - work[a, 1])
                    qz = work[a, 2] + t * (work[b, 2] - work[a, 2])
                if not started:
                    fx, fy, fz = qx, qy, qz
                    started = True
                else:
                    ux, uy, uz = px - fx, py - fy, pz - fz
                    wx, wy, wz = qx - fx, qy - fy, qz - fz
                    cx, cy, cz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
                    wetted += 0.5 * sqrt(cx * cx + cy * cy + cz * cz)
                    part_volume = ((fx - ox) * cx + (fy - oy) * cy + (fz - oz) * cz) / 6.0
                    volume += part_volume
                    mx += part_volume * 0.25 * (ox + fx + px + qx)
                    my += part_volume * 0.25 * (oy + fy + py + qy)
                    mz += part_volume * 0.25 * (oz + fz + pz + qz)
                px, py, pz = qx, qy, qz
    if volume <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    s = 1.0 / volume
    return volume, mx * s, my * s, mz * s, wetted


@item
def submerge(chosen, first, last, hulls, bodies, workspace, thread):
    """Submerged volume, centre of buoyancy (body frame), wetted area of the bodies chosen[first:last], to rows of `workspace.wet`.

    Two passes, the closed form and then what it leaves (volume -1); arrays are named once, outside the loops: a reference counted
    per floe costs more than the closed form.
    """
    q, wet, position = bodies.orientation, workspace.wet, bodies.position
    prism, plan, height = hulls.prism, hulls.plan, hulls.height
    for w in range(first, last):
        i = chosen[w]
        up = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])[2]
        valid, volume, cx, cy, cz, wetted = submerged_prism(position[i, 2], up[0], up[1], up[2], plan, height, i)
        if not (valid and prism[i]):
            volume = -1.0
        wet[i, 0], wet[i, 1], wet[i, 2], wet[i, 3], wet[i, 4] = volume, cx, cy, cz, wetted
    for w in range(first, last):
        if wet[chosen[w], 0] < 0.0:
            submerge_tilted(chosen[w], hulls, bodies, workspace, thread)


@device
def submerge_tilted(body, hulls, bodies, workspace, thread):
    """As `submerge`, for one body at any tilt."""
    q, wet = bodies.orientation, workspace.wet
    up = rotation_matrix(q[body, 0], q[body, 1], q[body, 2], q[body, 3])[2]
    wet[body, 0], wet[body, 1], wet[body, 2], wet[body, 3], wet[body, 4] = submerged_polyhedron(
        bodies.position[body, 2], up[0], up[1], up[2], hulls, body, workspace.hull, thread
    )
