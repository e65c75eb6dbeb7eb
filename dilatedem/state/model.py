"""Everything about a run that does not change."""

from typing import NamedTuple

import numpy as np

from dilatedem.geometry.shapes import Hulls, Shapes
from dilatedem.state.bodies import Solids
from dilatedem.state.charts import Charts
from dilatedem.state.records import Records
from dilatedem.state.setting import ContactSetting, Surroundings
from dilatedem.state.supports import Supports


class Model(NamedTuple):
    floating: int  # bodies that are no structures; those of structures are numbered after them
    structure_of: np.ndarray  # (n,) the structure that a body belongs to, -1 = none
    whole_of: np.ndarray  # (s,) the structure that a structure is a part of, -1 = none
    joined: np.ndarray  # (j, 2) first body of each floe of several parts, and the body behind its last one
    shapes: Shapes
    hulls: Hulls
    solids: Solids
    contact: ContactSetting
    loads: NamedTuple  # `water.loads.LoadSetting`
    surroundings: Surroundings
    charts: Charts
    records: Records
    supports: Supports

    @property
    def floes(self) -> int:
        """How many bodies float, those that are parts of one floe as one."""
        return self.floating - int((self.joined[:, 1] - self.joined[:, 0] - 1).sum())
