"""Numbers of a case that kernels need: contact parameters, water, domain. Constant during a run."""

from typing import NamedTuple


class ContactSetting(NamedTuple):
    """Parameters of contact. Each model has a class of its own, by which `contact.laws` chooses: only one model is compiled."""

    damping: float  # zeta_n of Liu 2015, Eq. (4)
    friction: float  # mu of Eq. (6)
    stiffness_ratio: float  # r_ns: tangential over normal stiffness


class Liu2015Setting(ContactSetting):
    __slots__ = ()


class ConsistentSetting(ContactSetting):
    __slots__ = ()


#: by the name of the model in a case
CONTACT_SETTINGS = {"liu2015": Liu2015Setting, "consistent": ConsistentSetting}


class Surroundings(NamedTuple):
    """The domain."""

    period_x: float  # m, 0 = not periodic
    period_y: float  # m, 0 = not periodic
