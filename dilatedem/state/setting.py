"""Numbers of a case that kernels need: contact parameters, water, domain. Constant during a run."""

from math import inf
from typing import NamedTuple


class ContactSetting(NamedTuple):
    """Parameters of contact. Each model, with and without crushing, has a class of its own, by which `contact.laws` and
    `contact.crushing` choose: only what a case uses is compiled."""

    damping: float  # zeta_n of Liu 2015, Eq. (4): the dashpot over the critical one, where an approach ends
    touch: bool  # whether the dashpot vanishes at touch
    stiffness_ratio: float  # r_ns: tangential over normal stiffness
    crushing_pressure: float = inf  # Pa, on 1 m2; and its exponent: of settings whose ice crushes
    crushing_exponent: float = 0.0


class Liu2015Setting(ContactSetting):
    __slots__ = ()


class Liu2015CrushingSetting(Liu2015Setting):
    __slots__ = ()


class ConsistentSetting(ContactSetting):
    __slots__ = ()


class ConsistentCrushingSetting(ConsistentSetting):
    __slots__ = ()


#: by the name of the model in a case, and whether its ice crushes
CONTACT_SETTINGS = {
    ("liu2015", False): Liu2015Setting,
    ("liu2015", True): Liu2015CrushingSetting,
    ("consistent", False): ConsistentSetting,
    ("consistent", True): ConsistentCrushingSetting,
}
#: those whose ice crushes
CRUSHING_SETTINGS = tuple(setting for (_, crushes), setting in CONTACT_SETTINGS.items() if crushes)


class Surroundings(NamedTuple):
    """The domain."""

    period_x: float  # m, 0 = not periodic
    period_y: float  # m, 0 = not periodic
