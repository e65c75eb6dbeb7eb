"""What is around a floating body where water may move by more than a steady current: a row of `Workspace.wet` a body.

Columns 0 to 4 as `water.floating.submerge` writes them for the still level; 5 to 9 the same for the surface there is, as a plane
over the body's centroid: meant for floes that are short against the waves. Then how the waves move the water at the depth of the
centre of that volume.
"""

from math import sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.rotation import rotation_matrix, to_body
from dilatedem.numerics.vector import load
from dilatedem.water.floating import submerge, submerged_polyhedron, submerged_prism
from dilatedem.water.waves import moving_water, surface

#: where in a row the cut by the surface begins: volume, centre (body frame), wetted area, as of the still level from column 0 on
SURFACE = 5
#: m, height of the surface over the body's centroid
LEVEL = 10
#: velocity [m/s] and acceleration [m/s2] of the waves' water, three columns each
WATER, ACCELERATION = 11, 14
#: about x and y, the water's turning [rad/s] and the rate of it [rad/s2], two columns each
SPIN, TURNING = 17, 19
COLUMNS = 21


@item
def submerge_at_sea(chosen, first, last, time, setting, hulls, bodies, workspace, thread):
    """The rows of the bodies chosen[first:last] at `time` [s]."""
    wet = workspace.wet
    submerge(chosen, first, last, hulls, bodies, workspace, thread)
    for w in range(first, last):
        i = chosen[w]
        if len(setting.wave) == 0:
            for column in range(SURFACE):
                wet[i, SURFACE + column] = wet[i, column]
        else:
            _lap(i, time, setting, hulls, bodies, workspace, thread)


@device
def _lap(i, time, setting, hulls, bodies, workspace, thread):
    """What waves make of the row of body i."""
    wet, q, (x, y, z) = workspace.wet, bodies.orientation, load(bodies.position, i)
    level, slope_x, slope_y = surface(x, y, time, setting)
    shrink = 1.0 / sqrt(1.0 + slope_x * slope_x + slope_y * slope_y)
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    up, height = to_body(R, (-slope_x * shrink, -slope_y * shrink, shrink)), (z - level) * shrink
    valid, volume, cx, cy, cz, wetted = submerged_prism(height, up[0], up[1], up[2], hulls.plan, hulls.height, i)
    if not (valid and hulls.prism[i]):
        volume, cx, cy, cz, wetted = submerged_polyhedron(height, up[0], up[1], up[2], hulls, i, workspace.hull, thread)
    wet[i, 5], wet[i, 6], wet[i, 7], wet[i, 8], wet[i, 9], wet[i, LEVEL] = volume, cx, cy, cz, wetted, level
    depth = max(0.0, -(height + up[0] * cx + up[1] * cy + up[2] * cz))
    velocity, acceleration, spin, turning = moving_water(x, y, depth, time, setting)
    for m in range(3):
        wet[i, WATER + m], wet[i, ACCELERATION + m] = velocity[m], acceleration[m]
    for m in range(2):
        wet[i, SPIN + m], wet[i, TURNING + m] = spin[m], turning[m]
