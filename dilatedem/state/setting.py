"""Numbers of a case that kernels need: contact parameters, water, domain. Constant during a run."""

from typing import NamedTuple


class ContactSetting(NamedTuple):
    """Parameters of contact. Each model, with each dashpot, has a class of its own, by which `contact.laws` chooses: only what a
    case uses is compiled."""

    damping: float  # zeta_n of Liu 2015, Eq. (4): the dashpot over the critical one, where an approach ends
    stiffness_ratio: float  # r_ns: tangential over normal stiffness


class Liu2015Setting(ContactSetting):
    __slots__ = ()


class ConsistentSetting(ContactSetting):
    __slots__ = ()


class ConsistentTouchSetting(ContactSetting):
    """`consistent` with a dashpot that vanishes at touch."""

    __slots__ = ()


#: by the names of the model and of its damping law in a case
CONTACT_SETTINGS = {
    ("liu2015", "viscous"): Liu2015Setting,
    ("consistent", "viscous"): ConsistentSetting,
    ("consistent", "touch"): ConsistentTouchSetting,
}


class Surroundings(NamedTuple):
    """The domain."""

    period_x: float  # m, 0 = not periodic
    period_y: float  # m, 0 = not periodic
