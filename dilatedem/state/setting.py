"""Numbers of a case that kernels need: contact parameters, water, domain. Constant during a run."""

from enum import IntEnum
from typing import NamedTuple


class ContactModel(IntEnum):
    """Which laws hold; `contact.collide` chooses by it."""

    LIU2015 = 0
    CONSISTENT = 1


class ContactSetting(NamedTuple):
    """Parameters of contact for `liu2015`; for `consistent` there is a class of its own, so that only one model is compiled."""

    model: int  # ContactModel
    damping: float  # zeta_n of Liu 2015, Eq. (4)
    friction: float  # mu of Eq. (6)
    stiffness_ratio: float  # r_ns: tangential over normal stiffness


class ConsistentSetting(ContactSetting):
    """The same for `consistent`."""

    __slots__ = ()


class Surroundings(NamedTuple):
    gravity: float  # m/s2, along -z
    water: bool  # whether there is any
    water_density: float  # kg/m3
    current_x: float  # m/s
    current_y: float  # m/s
    drag_force: float  # C_d^F of Liu 2015, Eq. (26)
    drag_moment: float  # C_d^M of Eq. (27)
    period_x: float  # m, 0 = not periodic
    period_y: float  # m, 0 = not periodic
