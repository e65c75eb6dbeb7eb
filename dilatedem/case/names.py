"""Names under which loads are recorded: which of them a structure cannot have."""

from collections.abc import Sequence

from dilatedem.case.bodies import Body
from dilatedem.keys import Fault, Table
from dilatedem.structures.held import name_of

#: of the walls of the domain
WALL_NAMES = ("wall_x_min", "wall_x_max", "wall_y_min", "wall_y_max")
#: of all structures together
TOTAL = "total"


def name_faults(structures: Sequence[Table], bodies: Sequence[Body]) -> list[Fault]:
    """What is wrong with the names of a case's structures."""
    found: list[Fault] = []
    first: dict[str, int] = {}
    held = {name_of(number) for number, body in enumerate(bodies) if body.fixed}
    for i, structure in enumerate(structures):
        if structure.name == TOTAL:
            found.append((("structure", i, "name"), "is kept for all structures together; choose another"))
        elif structure.name in WALL_NAMES:
            found.append((("structure", i, "name"), "is kept for a wall of the domain; choose another"))
        elif structure.name in held:
            found.append((("structure", i, "name"), "is kept for a fixed [[body]]; choose another"))
        elif structure.name in first:
            other = f"structure.{first[structure.name]}"
            found.append((("structure", i, "name"), f"is the name of {other} too; give each structure one of its own"))
        first.setdefault(structure.name, i)
    return found
