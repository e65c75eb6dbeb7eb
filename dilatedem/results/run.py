"""A run folder: its tables, maps, floes and snapshots, each read, once, when it is asked for."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.results.archive import Archive, read_archive
from dilatedem.results.doubts import doubts
from dilatedem.results.files import list_snapshots, read_case, read_summary
from dilatedem.results.maps import as_dataset
from dilatedem.results.packages import imported
from dilatedem.results.soundness import require_table
from dilatedem.results.tables import read_frame

if TYPE_CHECKING:
    import pandas
    import xarray

    from dilatedem.results.hits import KeptHit
    from dilatedem.results.snapshots import Snapshot


class Run:
    """What a run left behind, as far as it got. Of a run under way, load it anew to see what has come since.

    Whatever the run has no file for raises CaseError, in a sentence; tables and maps raise ImportError where pandas or xarray
    is not installed.
    """

    def __init__(self, path: Path):
        """Raises CaseError when there is no readable case.toml in the folder `path`."""
        self.path = path
        self.case: dict[str, Any] = read_case(path)

    def __repr__(self) -> str:
        title, status = self.case.get("title") or "without a title", self.summary.get("status", "status unknown")
        return f"<dilatedem run {str(self.path)!r}: {title}, {status}>"

    @cached_property
    def summary(self) -> dict[str, Any]:
        """summary.json; empty where there is none."""
        return read_summary(self.path / "summary.json")

    @property
    def doubts(self) -> list[str]:
        """A sentence for each thing about the energies that makes the loads doubtful, with the way on."""
        return doubts(self.summary)

    @cached_property
    def forces(self) -> pandas.DataFrame:
        """forces.csv: loads on structures, a row per window and structure."""
        return self._frame("forces.csv")

    @cached_property
    def energy(self) -> pandas.DataFrame:
        """energy.csv: the energy ledger."""
        return self._frame("energy.csv")

    @cached_property
    def bodies(self) -> pandas.DataFrame:
        """bodies.csv: motion of the tracked bodies."""
        return self._frame("bodies.csv")

    @cached_property
    def hits(self) -> pandas.DataFrame:
        """hits.csv: a row per separate load event of a structure, in the order in which they ended."""
        return self._frame("hits.csv")

    @property
    def hits_in_full(self) -> list[KeptHit]:
        """The highest load events, the highest first: the force at every step around the peak, and the floes that pushed."""
        return self._archive.hits

    @cached_property
    def structures(self) -> pandas.DataFrame:
        """structures.csv: motion of the structures that move, and what their bases bear; a run without such has no file."""
        return self._frame("structures.csv")

    def _frame(self, name: str) -> pandas.DataFrame:
        """A table that every run writes in one form. Raises CaseError where there is none or it is damaged."""
        frame = read_frame(self.path / name)
        require_table({column: frame[column].to_numpy() for column in frame}, self.path / name)
        return frame

    @property
    def load_map_names(self) -> list[str]:
        """The structures that have a load map."""
        return list(self._archive.load_maps)

    def load_map(self, structure: str) -> xarray.Dataset:
        """The load map of a structure: `impulse_Ns` by place and height; see `results.maps.as_dataset`."""
        maps = self._archive.load_maps
        if structure not in maps:
            known = f"there are maps of {', '.join(maps)}" if maps else "there is none in its run.h5"
            raise CaseError(f"{self.path}: no load map of {structure!r}; {known}")
        return as_dataset(maps[structure])

    @cached_property
    def contacts(self) -> pandas.DataFrame:
        """Contact statistics: a row per kind of pair (`ice_ice`, `ice_structure`) and mode, which make the index."""
        pandas = imported("pandas")
        contacts = self._archive.contacts
        if not contacts:
            raise CaseError(f"{self.path / 'run.h5'}: no contact statistics in it")
        frames = {pair: pandas.DataFrame(found.columns, index=found.mode) for pair, found in contacts.items()}
        return pandas.concat(frames, names=["pair", "mode"])

    @cached_property
    def floes(self) -> pandas.DataFrame:
        """The floes at t = 0, by their number: `x0_m`, `y0_m`, `plan_area_m2`, ... and `outline`, an array (k, 2) [m] each."""
        pandas = imported("pandas")
        floes = self._archive.floes
        if floes is None:
            raise CaseError(f"{self.path / 'run.h5'}: no table of floes in it")
        columns = dict(floes.columns)
        body = columns.pop("body", np.arange(len(floes.outlines)))
        outline = pandas.Series(floes.outlines, index=body, dtype=object)
        return pandas.DataFrame(columns, index=pandas.Index(body, name="body")).assign(outline=outline)

    @property
    def snapshot_times(self) -> np.ndarray:
        """(snapshots,) [s], ascending."""
        return np.array([time for time, _ in self._snapshots])

    def snapshot(self, time: float) -> Snapshot:
        """The readable snapshot nearest to `time` [s]."""
        from dilatedem.results.snapshots import nearest_snapshot  # meshio and shapely, only when they are wanted

        if not self._snapshots:
            raise CaseError(f"{self.path}: this run has no snapshots")
        try:
            return nearest_snapshot(self._snapshots, time)
        except OSError as error:
            raise CaseError(f"{self.path / 'snapshots'}: none of the snapshots can be read") from error

    @cached_property
    def _snapshots(self) -> list[tuple[float, Path]]:
        return list_snapshots(self.path, self.case)

    @cached_property
    def _archive(self) -> Archive:
        if not (self.path / "run.h5").is_file():
            raise CaseError(f"{self.path}: this run has no run.h5")
        return read_archive(self.path / "run.h5")
