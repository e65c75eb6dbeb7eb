"""The strips of ice that enter in the course of a run, as bodies: each a pure function of the case and of its number."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.field.placement import FloeField
from dilatedem.scene.arrays import build_model, initial_bodies
from dilatedem.scene.ice import Floes, ice_of_stream
from dilatedem.scene.inflow import strips_at_start
from dilatedem.scene.place import Scene, scene_of_floes
from dilatedem.state.bodies import Bodies
from dilatedem.state.model import Model

#: strips that are kept in memory: the one that comes next may have to wait, and be looked at again
KEPT = 2


@dataclass(frozen=True, eq=False)
class Newcomers:
    """The floes of a strip where they stood, or would have stood, at t = 0: ids (floes,); scene, model and bodies of them alone,
    beside the structures of the case; narrow: cells of the strip that are open water, too narrow for the dilated radius."""

    ids: np.ndarray
    scene: Scene
    model: Model
    bodies: Bodies
    narrow: int


class Entering:
    """All strips that can enter; those looked at last are kept in memory."""

    def __init__(self, case: Case, scene: Scene):
        self._case, self._scene, self.stream = case, scene, scene.stream
        #: the first that is not there at the start
        self.first = strips_at_start(case, self.stream).stop
        self.strip = lru_cache(KEPT)(self._strip)

    def _strip(self, number: int) -> Newcomers:
        floes, case = self.stream.strip(number), self._case
        count, areas = len(floes.outlines), floes.plan_area
        every = np.ones(count, np.bool_)
        field = FloeField(floes.outlines, areas, areas, self.stream.factor, self.stream.concentration, every)
        scene = scene_of_floes(case, Floes(field, ice_of_stream(case, self.stream, floes.which)), self._scene.structures)
        model = build_model(case, scene)
        return Newcomers(floes.which + self._shift, scene, model, initial_bodies(case, scene, model), floes.narrow)

    @property
    def _shift(self) -> int:
        """From the number of a cell of the stream to that of a body: they go on from the bodies that are there at the start."""
        return self._scene.count - self.stream.first(self.first)

    def strips_of(self, ids: np.ndarray) -> np.ndarray:
        """(n,) the strips that bodies have entered with; ids (n,): numbers that no body of the start has."""
        return np.array([self.stream.strip_of(int(number) - self._shift) for number in ids], np.int64)
