"""The domain of a case: its size, and what happens at its sides."""

from dilatedem.case.field import IceField
from dilatedem.keys import Boundary, Fault, Friction, Size2, Table, key


class Domain(Table):
    """The rectangle of sea, centred on the origin. The still water level is z = 0, z points up."""

    size: Size2 = key((50.0, 50.0), "m", "Extent along x (the usual direction of the current) and along y.")
    x_boundary: Boundary = key(
        "open", "",
        "The two sides at x = -size/2 and +size/2. Through `open` and `outflow` ice leaves: `open` goes on following it, "
        "`outflow` drops what has left as a whole. With `inflow` it leaves like that downstream, and new ice of the same kind "
        "enters upstream for as long as the run lasts.",
    )
    y_boundary: Boundary = key("open", "", "The two sides at y = -size/2 and +size/2.")
    wall_friction: Friction | None = key(
        None, "", "Coefficient of friction with sides that are a `wall`, such as those of a tank; `contact.friction` unless given."
    )

    @property
    def boundaries(self) -> tuple[str, str]:
        """Along x and along y."""
        return self.x_boundary, self.y_boundary

    @property
    def inflow(self) -> int | None:
        """The axis along which ice enters, if it does."""
        return self.boundaries.index("inflow") if "inflow" in self.boundaries else None

    def faults(self) -> list[Fault]:
        if self.boundaries == ("inflow", "inflow"):
            return [(("y_boundary",), "ice can enter along one axis only; take \"periodic\" for the other, or turn the scene")]
        if self.wall_friction is not None and "wall" not in self.boundaries:
            return [(("wall_friction",), 'needs a side that is a wall: x_boundary = "wall" or y_boundary = "wall"')]
        return []


def inflow_faults(domain: Domain, field: IceField, drift: tuple[float, float, float], key: str) -> list[Fault]:
    """Ice can enter where it is made by a recipe, and drifts along one axis.

    drift [m/s]: velocity of ice that enters, which the key `key` gives.
    """
    axis = domain.inflow
    if axis is None:
        return []
    where, along, across = ("domain", f"{'xy'[axis]}_boundary"), "xy"[axis], "xy"[1 - axis]
    if field.source != "voronoi":
        return [(where, 'needs ice that is made by a recipe, without an end: field.source must be "voronoi"')]
    if drift[axis] == 0.0:
        return [(where, f"needs ice that drifts along {along}, so that one side is upstream; {key} has 0 there")]
    if drift[1 - axis] != 0.0 and domain.boundaries[1 - axis] != "periodic":
        text = f"the ice drifts along {across}, too, by {drift[1 - axis]:g} m/s ({key}), out of the lane that it enters in"
        return [(where, f'{text}; take domain.{across}_boundary = "periodic", or turn the scene')]
    return []
