"""What a load on a floating body answers."""

from collections.abc import Callable
from typing import Any, NamedTuple


class LoadTerm(NamedTuple):
    """A load on every floating body.

    parameters: names of the numbers that its kernel reads from `water.loads.LoadSetting`; they are shared by all terms.
    of_case: those numbers in a case, by name, and those of `at_sea`.
    load: kernel (i, time, setting, hulls, solids, bodies, wet) that returns force [N] and torque about the centroid [N m] on body i
    at `time` [s], and the power of both [W], which counts where `work` names a term of the ledger; wet (n, 5): see
    `water.floating.submerge`, not to be read where setting.water is False; None: a load of cases that are `at_sea` alone.
    is_on: whether a setting has it at all.
    shortest_time: of a case, the time [s] over which it changes, at least; what touches nothing takes steps of 1/250 of it.
    at_sea: the same kernel where `Case.at_sea`, with a setting of `water.loads.SeaSetting` and wet (n, COLUMNS) of `water.sea`;
    `load` unless given. sea_parameters: names of what it reads besides.
    """

    parameters: tuple[str, ...]
    of_case: Callable[[Any], dict[str, Any]]
    load: Callable | None
    work: str = ""
    is_on: Callable[[Any], bool] = lambda setting: True
    shortest_time: Callable[[Any], float] = lambda case: float("inf")
    at_sea: Callable | None = None
    sea_parameters: tuple[str, ...] = ()
