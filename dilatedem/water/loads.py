"""All loads on a floating body but those of contacts: the terms, and their sum.

Of two kinds, by the class of the setting, so that a step is compiled with what its case has: water and wind that are steady, as in
the paper; and a sea, where they vary or floes take water along (`Case.at_sea`).
"""

from collections import namedtuple
from collections.abc import Callable

import numpy as np

from dilatedem.jit import by_type, item
from dilatedem.numerics.plain import norm
from dilatedem.numerics.vector import add
from dilatedem.water.floating import submerge
from dilatedem.water.sea import COLUMNS, SURFACE, submerge_at_sea
from dilatedem.water.term import LoadTerm
from dilatedem.water.terms import buoyancy, drag, wave, weight, wind

#: in the order in which they are added up
TERMS: tuple[LoadTerm, ...] = (weight.TERM, buoyancy.TERM, drag.TERM, wind.TERM, wave.TERM)

#: parameters of all terms, by name: flat, as parallel loops want it
LoadSetting = namedtuple("LoadSetting", dict.fromkeys(name for term in TERMS for name in term.parameters))
#: the same, and those of the terms at sea
SeaSetting = namedtuple("SeaSetting", [*LoadSetting._fields, *(name for term in TERMS for name in term.sea_parameters)])

#: terms of the ledger that loads do work for: the columns of `Bodies.power` and `Bodies.work`
WORKS = tuple(term.work for term in TERMS if term.work)


def load_setting(case) -> LoadSetting | SeaSetting:
    """The parameters of all terms in a case."""
    values = {name: value for term in TERMS for name, value in term.of_case(case).items()}
    kind = SeaSetting if case.at_sea else LoadSetting
    return kind(**{name: values[name] for name in kind._fields})


def works_of(setting: LoadSetting | SeaSetting) -> list[str]:
    """The works that a setting has at all."""
    return [term.work for term in TERMS if term.work and term.is_on(setting)]


def wet_columns(setting: LoadSetting | SeaSetting) -> int:
    """How long a row of `Workspace.wet` is."""
    return COLUMNS if isinstance(setting, SeaSetting) else SURFACE


def fastest_water(setting: LoadSetting | SeaSetting) -> float:
    """A speed [m/s] that the water never passes."""
    if not isinstance(setting, SeaSetting):
        return norm([setting.current_x, setting.current_y])
    orbits = float(np.sum(setting.wave[:, 0] * setting.wave[:, 4]))
    return float(norm(setting.current).max()) * float(np.abs(setting.shear).max()) + orbits


def shortest_time(case) -> float:
    """Time [s] over which the loads of a case change, at least."""
    return min(term.shortest_time(case) for term in TERMS)


@item
def _submerge(setting, time, chosen, first, last, hulls, bodies, workspace, thread):
    submerge(chosen, first, last, hulls, bodies, workspace, thread)


@item
def _submerge_at_sea(setting, time, chosen, first, last, hulls, bodies, workspace, thread):
    submerge_at_sea(chosen, first, last, time, setting, hulls, bodies, workspace, thread)


#: What is under water of the bodies chosen[first:last] at `time` [s], to rows of `workspace.wet`.
wet_bodies = by_type(_submerge, {SeaSetting: _submerge_at_sea})


def _summed(loads: tuple[tuple[Callable, str], ...]) -> Callable:
    """A kernel that adds these loads, one after the other, to a force and a torque, and books the work that each has a name for."""
    if not loads:

        @item
        def nothing(i, dt, time, setting, hulls, solids, bodies, wet, force, torque):
            return force, torque

        return nothing
    (load, work), rest = loads[0], _summed(loads[1:])
    column = WORKS.index(work) if work else -1

    @item
    def added(i, dt, time, setting, hulls, solids, bodies, wet, force, torque):
        own_force, own_torque, power = load(i, time, setting, hulls, solids, bodies, wet)
        if column >= 0:
            bodies.work[i, column] += 0.5 * dt * (power + bodies.power[i, column])
            bodies.power[i, column] = power
        return rest(i, dt, time, setting, hulls, solids, bodies, wet, add(force, own_force), add(torque, own_torque))

    return added


_steady = _summed(tuple((term.load, term.work) for term in TERMS if term.load))
_varying = _summed(tuple((term.at_sea or term.load, term.work) for term in TERMS))
_sum = by_type(_steady, {SeaSetting: _varying}, at=3)


@item
def body_loads(i, dt, time, setting, hulls, solids, bodies, wet):
    """Force [N] and torque about the centroid [N m] of all terms on body i at `time` [s]; their work in `dt` [s] is booked."""
    return _sum(i, dt, time, setting, hulls, solids, bodies, wet, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
