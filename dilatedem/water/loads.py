"""All loads on a floating body but those of contacts: the terms, and their sum."""

from collections import namedtuple
from collections.abc import Callable

from dilatedem.jit import item
from dilatedem.numerics.vector import add
from dilatedem.water.term import LoadTerm
from dilatedem.water.terms import buoyancy, drag, weight, wind

#: in the order in which they are added up
TERMS: tuple[LoadTerm, ...] = (weight.TERM, buoyancy.TERM, drag.TERM, wind.TERM)

#: parameters of all terms, by name: flat, as parallel loops want it
LoadSetting = namedtuple("LoadSetting", dict.fromkeys(name for term in TERMS for name in term.parameters))

#: terms of the ledger that loads do work for: the columns of `Bodies.power` and `Bodies.work`
WORKS = tuple(term.work for term in TERMS if term.work)


def load_setting(case) -> LoadSetting:
    """The parameters of all terms in a case."""
    return LoadSetting(**{name: value for term in TERMS for name, value in term.of_case(case).items()})


def works_of(setting: LoadSetting) -> list[str]:
    """The works that a setting has at all."""
    return [term.work for term in TERMS if term.work and term.is_on(setting)]


def shortest_time(case) -> float:
    """Time [s] over which the loads of a case change, at least."""
    return min(term.shortest_time(case) for term in TERMS)


def _summed(terms: tuple[LoadTerm, ...]) -> Callable:
    """A kernel that adds these terms, one after the other, to a force and a torque, and books the work of each."""
    if not terms:

        @item
        def nothing(i, dt, time, setting, hulls, solids, bodies, wet, force, torque):
            return force, torque

        return nothing
    load, rest = terms[0].load, _summed(terms[1:])
    column = WORKS.index(terms[0].work) if terms[0].work else -1

    @item
    def added(i, dt, time, setting, hulls, solids, bodies, wet, force, torque):
        own_force, own_torque, power = load(i, time, setting, hulls, solids, bodies, wet)
        if column >= 0:
            bodies.work[i, column] += 0.5 * dt * (power + bodies.power[i, column])
            bodies.power[i, column] = power
        return rest(i, dt, time, setting, hulls, solids, bodies, wet, add(force, own_force), add(torque, own_torque))

    return added


_sum = _summed(TERMS)


@item
def body_loads(i, dt, time, setting, hulls, solids, bodies, wet):
    """Force [N] and torque about the centroid [N m] of all terms on body i at `time` [s]; their work in `dt` [s] is booked."""
    return _sum(i, dt, time, setting, hulls, solids, bodies, wet, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
