"""From an overlap profile to force, energy and moment: grids chosen by the contact itself, halved once to state the error."""

from dataclasses import dataclass

import numpy as np

from validation.half_space.profile import Profile
from validation.half_space.solver import solve

#: cells of the finest grid; the coarser ones have a quarter and a sixteenth
CELLS = 2**17

#: passes of the coarsest grid that fit the box to the contact
FITTING_PASSES = 4


@dataclass(frozen=True)
class Contact:
    """Results in units of E*.

    force [m2]; energy [m3]; moment [m3] of the pressure about the reference point, positive where the deep end carries more;
    energy_moment [m3] = dW/d(tilt) at fixed overlap of the reference point: at most force x radius x tilt more, since the surface
    rolls along as it tilts; centre: x of the centre of pressure [m]; extent: lengths [m] of the contact along x and y; area [m2];
    peak p/E*.
    """

    force: float
    energy: float
    moment: float
    energy_moment: float
    centre: float
    extent: tuple[float, float]
    area: float
    peak: float


@dataclass(frozen=True)
class Result:
    """The contact on the finest grid (extrapolated where the profile is cut); the relative change of force, energy and moment since
    the grid of twice its cell size; cells: (nx, ny) of the finest."""

    contact: Contact
    force_error: float
    energy_error: float
    moment_error: float
    cells: tuple[int, int]


def centres(low: float, high: float, count: int) -> np.ndarray:
    return low + (np.arange(count) + 0.5) * (high - low) / count


def shape_for(box, cells: int) -> tuple[int, int]:
    """nx, ny with about `cells` in all; cells are long along the longer side by the square root of the box's ratio, since a slender
    contact varies most across, but narrows at its ends too."""
    ratio = np.sqrt((box[1] - box[0]) / (box[3] - box[2]))
    nx, ny = np.sqrt(cells * ratio), np.sqrt(cells / ratio)
    return max(8, 4 * round(nx / 4)), max(8, 4 * round(ny / 4))


def evaluate(profile: Profile, box, shape, start=None):
    """Contact on the grid `shape` over `box`, and its pressure."""
    x, y = centres(box[0], box[1], shape[0])[:, None], centres(box[2], box[3], shape[1])[None, :]
    dx, dy = (box[1] - box[0]) / shape[0], (box[3] - box[2]) / shape[1]
    overlap = profile.overlap(x, y) + np.zeros(shape)
    pressure = solve(overlap, dx, dy, start).values
    load = pressure * dx * dy
    force = float(load.sum())
    arm = x - profile.reference if profile.arm is None else profile.arm(x, y)
    touched = [np.flatnonzero((pressure > 0).any(axis=axis)) for axis in (1, 0)]
    return Contact(
        force=force,
        energy=float(0.5 * (load * overlap).sum()),
        moment=float((load * (profile.reference - x)).sum()),
        energy_moment=-float((load * arm).sum()),
        centre=float((load * x).sum() / force),
        extent=tuple(float((t[-1] - t[0] + 1) * d) for t, d in zip(touched, (dx, dy), strict=True)),
        area=float((pressure > 0).sum() * dx * dy),
        peak=float(pressure.max()),
    ), pressure


def fitted(box, pressure) -> tuple[float, float, float, float]:
    """The box drawn close around the contact; a side that the contact reaches stays where it is, so that sharp sides stay exact."""
    sides = list(box)
    for axis in (0, 1):
        low, high = box[2 * axis], box[2 * axis + 1]
        count = pressure.shape[axis]
        step = (high - low) / count
        touched = np.flatnonzero((pressure > 0).any(axis=1 - axis))
        margin = 2 + round(0.02 * (touched[-1] - touched[0]))
        if touched[0] > margin:
            sides[2 * axis] = low + (touched[0] - margin) * step
        if touched[-1] < count - 1 - margin:
            sides[2 * axis + 1] = low + (touched[-1] + 1 + margin) * step
    return tuple(sides)


def relative(fine: float, coarse: float, scale: float) -> float:
    return abs(fine - coarse) / scale if scale else 0.0


def resolve(profile: Profile, cells: int = CELLS) -> Result:
    """Contact of the profile on about `cells` cells.

    Pressures are singular at cut sides, and errors in proportion to the cell size: such results are extrapolated from the last two
    grids (Richardson, first order).
    """
    box = profile.box
    for _ in range(FITTING_PASSES):
        shape = shape_for(box, cells // 16)
        _, pressure = evaluate(profile, box, shape)
        smaller = fitted(box, pressure)
        if smaller == box:
            break
        box = smaller
    shape = shape_for(box, cells // 16)
    _, pressure = evaluate(profile, box, shape)
    coarse = None
    for _ in range(2):
        shape = tuple(2 * count for count in shape)
        before, (coarse, pressure) = coarse, evaluate(profile, box, shape, pressure.repeat(2, axis=0).repeat(2, axis=1))
    fine, coarse = coarse, before
    errors = [relative(getattr(fine, name), getattr(coarse, name), getattr(fine, name)) for name in ("force", "energy")]
    lever = max(abs(fine.moment), 1e-3 * fine.force * (profile.box[1] - profile.box[0]))
    errors.append(relative(fine.moment, coarse.moment, lever))
    if profile.cut:
        names = ("force", "energy", "moment", "energy_moment")
        fine = Contact(**{**vars(fine), **{name: 2 * getattr(fine, name) - getattr(coarse, name) for name in names}})
    return Result(fine, *errors, shape)
