"""What a user of a simulation looks at: its floes and its structures at this moment, in copies that later steps do not change."""

from collections.abc import Iterator, Mapping

import numpy as np

from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import turned
from dilatedem.results.snapshots import plan_outlines


class Floes:
    """The n floating bodies that there are now, explicit ones and those held fast included; every array has a row for each."""

    def __init__(self, simulation):
        self._model, self._bodies, self._ids = simulation.model, simulation.state.bodies, simulation.state.ids

    def __len__(self) -> int:
        return self._model.floating

    def _rows(self, values: np.ndarray) -> np.ndarray:
        return values[: self._model.floating].copy()

    @property
    def id(self) -> np.ndarray:
        """(n,) numbers; a body keeps its own when others leave."""
        return self._ids.body.copy()

    @property
    def position(self) -> np.ndarray:
        """(n, 3) [m] of the centroids; not wrapped at periodic sides."""
        return self._rows(self._bodies.position)

    @property
    def orientation(self) -> np.ndarray:
        """(n, 4) unit quaternions, scalar first, body to world."""
        return self._rows(self._bodies.orientation)

    @property
    def velocity(self) -> np.ndarray:
        """(n, 3) [m/s]."""
        return self._rows(self._bodies.velocity)

    @property
    def angular_velocity(self) -> np.ndarray:
        """(n, 3) [rad/s] about the world's axes."""
        return self._rows(self._bodies.angular_velocity)

    @property
    def contact_force(self) -> np.ndarray:
        """(n, 3) [N] of all contacts together."""
        return self._rows(self._bodies.contact_force)

    @property
    def mass(self) -> np.ndarray:
        """(n,) [kg]."""
        return self._rows(self._model.solids.mass)

    @property
    def outline(self) -> list[np.ndarray]:
        """n outlines (k, 2) [m] as seen from above."""
        hulls = self._model.hulls
        owner = np.repeat(np.arange(len(self)), np.diff(hulls.vertex_start))
        corners = turned(matrix_from_quaternion(self.orientation)[owner], hulls.vertex)
        return plan_outlines((corners + self.position[owner])[:, :2], owner, len(self))


class StructureNow:
    """One structure, or several together, at this moment."""

    def __init__(self, simulation, number: int):
        self._loads, self._excursions, self._number = simulation.state.loads, simulation.state.excursions, number
        self.name = simulation.scene.records[number].name

    @property
    def load(self) -> np.ndarray:
        """(6,) force [N] of the ice on it in the last step, and moment [N m] about its centre at `output.moment_level`."""
        return self._loads.step_load[self._number].copy()

    @property
    def displacement(self) -> np.ndarray:
        """(3,) how far it is from its place along x and y [m] and about z [rad]; zero where it is held."""
        return self._excursions.displacement[self._number].copy()

    @property
    def velocity(self) -> np.ndarray:
        """(3,) along x and y [m/s] and about z [rad/s]."""
        return self._excursions.velocity[self._number].copy()

    @property
    def contacts(self) -> int:
        """Contacts with it in the last step."""
        return int(self._loads.step_contacts[self._number])


class Structures(Mapping):
    """All structures by name; `total`, where the case has several, is not listed but can be asked for."""

    def __init__(self, simulation):
        self._simulation = simulation
        self._numbers = {record.name: number for number, record in enumerate(simulation.scene.records)}

    def __getitem__(self, name: str) -> StructureNow:
        return StructureNow(self._simulation, self._numbers[name])

    def __iter__(self) -> Iterator[str]:
        return iter([structure.name for structure in self._simulation.scene.structures])

    def __len__(self) -> int:
        return len(self._simulation.scene.structures)
