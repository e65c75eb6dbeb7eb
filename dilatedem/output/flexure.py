"""flexure.csv: what pulls each floe that bends most."""

import numpy as np

from dilatedem.files.atomic import write_text
from dilatedem.output import folder
from dilatedem.output.observer import Observer
from dilatedem.output.tables import FLEXURE_COLUMNS, whole

#: bytes of a row, about
ROW = 120.0
MEANING = (
    "largest principal stress of the modes at the surface, at every step; floes whose was above ice.flexural_strength would have "
    "broken and go on whole; flexure.csv has each floe's, with time and place"
)


class Flexure(Observer):
    """A row a floe that bends, rewritten where the state is saved; no file where none does."""

    name = "flexure"

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return ROW * floes if case.bends else 0.0

    def refresh(self) -> None:
        if self.simulation.case.bends:
            self.background.put(write_text, self.out / folder.FLEXURE, whole(FLEXURE_COLUMNS, self._rows()))

    def _rows(self) -> list[tuple]:
        bodies, solids, rows = self.simulation.state.bodies, self.simulation.model.solids, []
        for i in np.flatnonzero(solids.mode_count).tolist():
            place = solids.stress_point[bodies.peak_place[i]].tolist() if bodies.peak_tension[i] > 0.0 else ["", "", ""]
            failed = bodies.failed_at[i] < np.inf
            where = [float(bodies.failed_at[i]), *bodies.failed_place[i].tolist()] if failed else ["", "", "", ""]
            rows.append((i, float(bodies.peak_tension[i]), float(bodies.peak_time[i]), *place, int(failed), *where))
        return rows

    def summary(self) -> dict:
        simulation = self.simulation
        if not simulation.case.bends:
            return {}
        bodies, bend = simulation.state.bodies, np.flatnonzero(simulation.model.solids.mode_count)
        most = int(bend[bodies.peak_tension[bend].argmax()])
        failed = np.flatnonzero(bodies.failed_at < np.inf)
        return {
            "flexure": {
                "strength_Pa": simulation.case.ice.flexural_strength,
                "floes": len(bend),
                "above_strength": len(failed),
                "first_above_s": float(bodies.failed_at[failed].min()) if len(failed) else None,
                "largest_Pa": float(bodies.peak_tension[most]),
                "largest_time_s": float(bodies.peak_time[most]),
                "largest_body": most,
                "meaning": MEANING,
            }
        }
