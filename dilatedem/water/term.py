"""What a load on a floating body answers."""

from collections.abc import Callable
from typing import Any, NamedTuple


class LoadTerm(NamedTuple):
    """A load on every floating body.

    parameters: names of the numbers that its kernel reads from `water.loads.LoadSetting`; they are shared by all terms.
    of_case: those numbers in a case, by name.
    load: kernel (i, time, setting, hulls, solids, bodies, wet) that returns force [N] and torque about the centroid [N m] on body i
    at `time` [s], and the power of both [W], which counts where `work` names a term of the ledger; wet (n, 5): see
    `water.floating.submerge`, not to be read where setting.water is False. is_on: whether a setting has it at all.
    shortest_time: of a case, the time [s] over which it changes, at least; what touches nothing takes steps of a thousandth of it.
    """

    parameters: tuple[str, ...]
    of_case: Callable[[Any], dict[str, float]]
    load: Callable
    work: str = ""
    is_on: Callable[[Any], bool] = lambda setting: True
    shortest_time: Callable[[Any], float] = lambda case: float("inf")
