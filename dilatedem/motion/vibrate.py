"""Motion of structures on beams: each mode of the beam swings by itself, and the structure goes as their sum does.

    q'' + 2 zeta omega q' + omega^2 q = phi F   of each mode, modal mass 1, F the load of the ice at the place that it pushes,
    u = sum phi q   of that place,

in the steps of `motion.carry`. The foot bears the load less what accelerates the beam, F - sum (integral of m phi) q'', and so does
it of its moment: a steady load comes down whole, however few the modes (mode acceleration).
"""

from math import sqrt

from dilatedem.jit import device


@device
def vibrate(s, dt, supports, excursions):
    """Half a kick and the whole move of the modes of structure s; its velocity becomes a prediction for the end of the step."""
    for c in range(2):
        place = middle = velocity = 0.0
        for k in range(supports.mode_start[s], supports.mode_start[s + 1]):
            kick, shape = 0.5 * dt * excursions.mode_force[k, c], supports.mode_shape[k, c]
            half = excursions.mode_rate[k, c] + kick
            excursions.mode_middle_rate[k, c] = half
            excursions.mode[k, c] += dt * half
            excursions.mode_rate[k, c] = half + kick
            place += shape * excursions.mode[k, c]
            middle += shape * half
            velocity += shape * excursions.mode_rate[k, c]
        excursions.displacement[s, c] = place
        excursions.middle_velocity[s, c] = middle
        excursions.velocity[s, c] = velocity


@device
def push_modes(s, dt, loads, supports, excursions):
    """The load of this instant on the modes of structure s, the second half of their kick, and what their damping took."""
    for c in range(2):
        ice, foot = loads.step_load[s, c], excursions.foot
        velocity, shear, moment = 0.0, ice, supports.push_height[s] * ice
        for k in range(supports.mode_start[s], supports.mode_start[s + 1]):
            middle, shape = excursions.mode_middle_rate[k, c], supports.mode_shape[k, c]
            dashpot = -supports.mode_damping[k, c] * excursions.mode_rate[k, c]
            excursions.loss[s] -= 0.5 * dt * (dashpot + excursions.mode_dashpot[k, c]) * middle
            force = shape * ice - supports.mode_square[k, c] * excursions.mode[k, c] + dashpot
            excursions.mode_dashpot[k, c], excursions.mode_force[k, c] = dashpot, force
            if dt > 0.0:
                excursions.mode_rate[k, c] = middle + 0.5 * dt * force
            velocity += shape * excursions.mode_rate[k, c]
            shear -= supports.mode_shear[k, c] * force
            moment -= supports.mode_moment[k, c] * force
        excursions.velocity[s, c], excursions.ice[s, c] = velocity, ice
        # a force along x turns the beam about y, one along y the other way about x
        foot[s, c], foot[s, 3 - c] = shear, moment if c == 0 else -moment
    _note_most(s, loads.steps[0] == 0, excursions.foot, excursions.foot_most)


@device
def _note_most(s, first, foot, most):
    """Size of force and moment of the foot of structure s, the highest of the open window; first: step of it."""
    for m in range(2):
        x, y = foot[s, 2 * m], foot[s, 2 * m + 1]
        size = sqrt(x * x + y * y)
        most[s, m] = size if first else max(most[s, m], size)
