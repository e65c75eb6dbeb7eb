"""Everything about a run that does not change."""

from typing import NamedTuple

from dilatedem.geometry.shapes import Hulls, Shapes
from dilatedem.state.bodies import Solids
from dilatedem.state.setting import ContactSetting, Surroundings


class Model(NamedTuple):
    floating: int  # bodies that are no structures; structures are numbered after them
    shapes: Shapes
    hulls: Hulls
    solids: Solids
    contact: ContactSetting
    surroundings: Surroundings
