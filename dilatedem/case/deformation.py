"""Bodies that bend: the table `[deformation]` of a case file."""

from typing import Annotated

from pydantic import Field

from dilatedem.keys import Positive, Table, key

#: modes of a body, at most: what an engineer would ask for, and a step can afford
MOST_MODES = 200


class Deformation(Table):
    """How bodies bend: by the lowest of the modes in which they vibrate when free."""

    modes: Annotated[int, Field(ge=0, le=MOST_MODES)] = key(0, "", "Modes of each body that is not held; 0: it is rigid.")
    damping: Annotated[float, Field(ge=0, lt=1)] = key(0.02, "", "Damping ratio of every mode.")
    strains: bool = key(
        False, "", "Whether the six shapes of uniform strain are added to the modes: pressed faces then give way as far as they do."
    )
    mesh_size: Positive = key(0.25, "m", "Size of the finite elements that modes are found with.")
