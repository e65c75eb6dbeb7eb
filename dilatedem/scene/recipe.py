"""What the field of a case is cut from, and which sides of the domain cut it."""

from dilatedem.case.schema import Case
from dilatedem.field.recipe import Recipe


def recipe_of(case: Case) -> Recipe:
    """How the cells of a case's field come about."""
    return Recipe(case.field.shape, case.field.regularity, case.field.size_distribution)


def periodic_axes(case: Case) -> tuple[bool, bool]:
    """Whether the domain is periodic along x and along y."""
    return case.domain.x_boundary == "periodic", case.domain.y_boundary == "periodic"


def ragged_axes(case: Case) -> tuple[bool, bool]:
    """Whether cells stick out of the domain along x and along y, as they come: through sides that ice may pass."""
    boundaries = (case.domain.x_boundary, case.domain.y_boundary)
    x, y = (case.field.front == "ragged" and boundary not in ("periodic", "wall") for boundary in boundaries)
    return x, y


def whole_axes(case: Case) -> tuple[bool, bool]:
    """Whether no side along x, and along y, cuts a cell."""
    x, y = (periodic or ragged for periodic, ragged in zip(periodic_axes(case), ragged_axes(case), strict=True))
    return x, y
