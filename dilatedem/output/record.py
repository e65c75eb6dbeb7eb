"""run.h5 as an observer: where on each structure the load acted, how floes touched, the floes of the start."""

import math
from functools import lru_cache

import numpy as np

from dilatedem.output import folder
from dilatedem.output.archive import ContactStatistics, FloeTable, LoadMap, PlanOutline, RunArchive, direction
from dilatedem.output.kept_hits import kept_hits
from dilatedem.output.observer import Observer
from dilatedem.state.ledger import TERMS
from dilatedem.state.loads import HEIGHT_BINS, PLACE_BINS
from dilatedem.structures.kind import Sketch

#: where the first axis of a load map lies, of a structure that moves
GOES_WITH = "; the map goes with the structure, of which this is said at t = 0"
#: bytes of run.h5, about: of itself, of every floe and every structure
FILE, FLOE, MAP = 3e5, 350.0, 25e3


def floe_table(scene, ids: np.ndarray | None = None) -> FloeTable:
    """All bodies of a `scene.place.Scene`; ids (n,): their numbers, from 0 on unless given."""
    body = np.arange(scene.count) if ids is None else ids
    return FloeTable(
        body=body, x0=scene.position[:, 0], y0=scene.position[:, 1], plan_area=scene.plan_area, mass=scene.mass(),
        volume=scene.volume(), vertices=scene.core_vertices(), floe=body[scene.joints.first()], outlines=scene.outlines,
    )  # fmt: skip


class Record(Observer):
    """Written whenever the state is saved: it is small.

    Its table of floes is that of the start; where ice enters, it holds the floes that are there, and those that load events name.
    """

    name = "record"
    _archive: RunArchive | None = None  # until it is written first

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        if entering := self.simulation.entering:
            self._of_strip = lru_cache(entering.stream.kept)(self._table_of)

    def _table_of(self, number: int) -> FloeTable:
        """The floes of a strip that entered, or will: a small part of all that makes it bodies."""
        strip = self.simulation.entering.strip(number)
        return floe_table(strip.scene, strip.ids)

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return FILE + FLOE * floes + MAP * structures

    def save(self) -> None:
        simulation = self.simulation
        hits = kept_hits(simulation.state.hits, simulation.dt, simulation.scene.orientation)
        floes = self._floes_there(hits) if simulation.entering else None
        self.background.put(self._write, self._load_maps(), self._contact_statistics(), hits, floes)

    def _write(
        self, maps: list[LoadMap], statistics: dict[str, ContactStatistics], hits: dict[str, np.ndarray], floes: FloeTable | None
    ) -> None:
        """In the background, as laying it out takes a while, too; floes: None for those of the start."""
        if self._archive and floes:
            self._archive.close()
            self._archive = None
        if self._archive:
            self._archive.update(maps, statistics, hits)
        else:
            case = self.simulation.case
            about = {"title": case.title, "seed": case.field.seed, "current_velocity_m_s": self._current()}
            about |= {"energy_terms": [term.name for term in TERMS], "energy_labels": [term.label for term in TERMS]}
            floes = floes or floe_table(self.simulation.scene)
            self._archive = RunArchive(
                maps, statistics, floes, outlines=self._outlines(), about=about, hits=hits, dt=self.simulation.dt
            )
        self._archive.write(self.out / folder.RUN_ARCHIVE)

    def _current(self) -> tuple[float, float]:
        """Velocity of the water [m/s]; zero where it is switched off."""
        water = self.simulation.case.water
        return tuple(water.velocity) if water.enabled else (0.0, 0.0)

    def _load_maps(self) -> list[LoadMap]:
        """At this moment, in copies."""
        simulation, impulse = self.simulation, self.simulation.state.loads.impulse_map
        u, v = self._current()
        maps = []
        for s, structure in enumerate(simulation.scene.structures):
            if structure.chart is None:
                continue
            chart, charts = structure.chart, simulation.model.charts
            low, high = charts.heights[s]
            zero = f"{chart.zero}{GOES_WITH if structure.support.moves else ''}"
            maps.append(LoadMap(
                structure=structure.name, kind=structure.about.kind, impulse=impulse[charts.map[s]].copy(), place=chart.place,
                label=chart.label, zero=zero, edges=chart.edges(PLACE_BINS),
                height_edges=np.linspace(low, high, HEIGHT_BINS + 1), duration_s=simulation.time_s,
                center=structure.about.place[:2] if chart.origin is None else chart.origin, radius=chart.radius, axis=chart.axis,
                upstream_deg=direction(-u, -v),
            ))  # fmt: skip
        return maps

    def _contact_statistics(self) -> dict[str, ContactStatistics]:
        """At this moment, in copies."""
        loads = self.simulation.state.loads
        columns = (loads.mode_steps, loads.mode_impulse, loads.mode_force, loads.mode_overlap)
        return {
            partners: ContactStatistics(*(values[p].copy() for values in columns))
            for p, partners in enumerate(("ice_ice", "ice_structure"))
        }

    def _floes_there(self, hits: dict[str, np.ndarray]) -> FloeTable:
        """The bodies that are there now, and those that load events name, by their numbers."""
        simulation, scene, entering = self.simulation, self.simulation.scene, self.simulation.entering
        named = [hits["floe"][k, :count] for k, count in enumerate(hits["floes"])] if hits else []
        wanted = np.unique(np.concatenate([simulation.state.ids.body, *named]))
        tables = [floe_table(scene).rows(wanted[wanted < scene.count])]
        since = wanted[wanted >= scene.count]
        strips = entering.strips_of(since)
        for number in np.unique(strips):
            table = self._of_strip(int(number))
            tables.append(table.rows(np.searchsorted(table.body, since[strips == number])))
        return FloeTable.of(tables)

    def _outlines(self) -> list[PlanOutline]:
        extent, outlines = math.hypot(*self.simulation.case.domain.size), []
        for structure in self.simulation.scene.structures:
            sketch = structure.about.sketch(extent) or Sketch(np.zeros((0, 2)), bounded=False)
            outlines.append(PlanOutline(structure.name, structure.about.kind, sketch.outline, sketch.bounded, structure.place[:2]))
        return outlines

    def close(self) -> None:
        if self._archive:
            self._archive.close()
