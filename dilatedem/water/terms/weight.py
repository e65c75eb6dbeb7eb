"""Weight."""

from dilatedem.jit import item
from dilatedem.water.term import LoadTerm


def of_case(case) -> dict[str, float]:
    """gravity [m/s2], along -z."""
    return {"gravity": case.gravity.acceleration}


@item
def weight(i, time, setting, hulls, solids, bodies, wet):
    """m g, at the centroid; its work is the energy `gravity`."""
    return (0.0, 0.0, -solids.mass[i] * setting.gravity), (0.0, 0.0, 0.0), 0.0


TERM = LoadTerm(("gravity",), of_case, weight)
