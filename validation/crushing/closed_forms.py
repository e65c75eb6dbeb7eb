"""The closed forms of crushing, one by one: a case of this folder, what to set in it, and what must come out."""

from collections.abc import Callable
from dataclasses import dataclass
from math import radians

from validation.crushing import hits
from validation.crushing.references import (
    Crushing,
    Expected,
    corner_on_wall,
    face_on_wall,
    rigid,
    round_on_pile,
    series,
    side_on_pile,
    sphere_on_wall,
)

HEIGHT, PILE, ROUND = 0.5, 2.0, 1.58  # m
SIDE = side_on_pile(HEIGHT, PILE)
#: edges that are all but sharp, and one as of floes
SQUARE, BLUNT, ROUNDED = (
    corner_on_wall(HEIGHT, radians(angle), radius) for angle, radius in ((90.0, 0.001), (120.0, 0.001), (90.0, 0.04))
)
#: overlap [m] up to which elastic laws are looked up, at 1 GPa: the lines of liu2015 are far softer
DEEPEST = {"liu2015": 1e-2, "consistent": 2e-3}


@dataclass(frozen=True)
class ClosedForm:
    """A body of a case that crushes in the limit of stiff ice."""

    name: str
    what: str
    case: str  # file in this folder
    area: Callable[[float], float]  # m2, nominal, over the depth
    pressure: float  # Pa, on 1 m2
    exponent: float = 0.0
    speed: float = 0.3  # m/s
    push: float = 0.0  # N: the weight of a body that falls

    @property
    def crushing(self) -> Crushing:
        return Crushing(self.area, self.pressure, self.exponent)

    def settings(self, *more: str) -> tuple[str, ...]:
        direction = "[0.0, 0.0, -{0:g}]" if self.push else "[{0:g}, 0.0, 0.0]"
        own = [
            f"ice.crushing_pressure={self.pressure:g}",
            f"ice.crushing_exponent={self.exponent:g}",
            f"body.0.velocity={direction.format(self.speed)}",
        ]
        if self.push:
            own.append(f"gravity.acceleration={self.push / MASS:.9g}")
        return (*own, *more)

    def hit(self, *more: str) -> hits.Hit:
        return hits.hit(self.case, *self.settings(*more))

    def rigid(self, mass: float) -> Expected:
        return rigid(self.crushing, mass, self.speed, self.push)


#: kg, of the floe of side_on_pile and pushed_side
MASS = 3587.0
RIGID = (
    ClosedForm("A1a", "side on the pile, 1 MPa, 0.3 m/s", "side_on_pile", SIDE, 1e6),
    ClosedForm("A1b", "the same, 2 MPa", "side_on_pile", SIDE, 2e6),
    ClosedForm("A1c", "the same, 1 MPa, 1 m/s", "side_on_pile", SIDE, 1e6, speed=1.0),
    ClosedForm("A1d", "a floe of 183 t on the pile, 1.5 MPa, 0.5 m/s", "large_side_on_pile", SIDE, 1.5e6, speed=0.5),
    ClosedForm("A2", "round floe on the pile, 1 MPa", "round_on_pile", round_on_pile(HEIGHT, ROUND, PILE), 1e6),
    ClosedForm("A3a", "square corner on a wall, 1 MPa", "corner_on_wall", SQUARE, 1e6),
    ClosedForm("A3b", "corner of 120° on a wall, 1 MPa", "blunt_corner_on_wall", BLUNT, 1e6),
    ClosedForm("A3c", "square corner rounded by 0.04 m, 2 MPa", "rounded_corner_on_wall", ROUNDED, 2e6),
    ClosedForm("A4", "sphere on a wall, 2 MPa, 1 m/s", "sphere_on_wall", sphere_on_wall(0.5), 2e6, speed=1.0),
    ClosedForm("A6a", "side on the pile, p = 1 MPa A^-0.3", "side_on_pile", SIDE, 1e6, -0.3),
    ClosedForm("A6b", "square corner on a wall, p = 1 MPa A^-0.5", "corner_on_wall", SQUARE, 1e6, -0.5),
    ClosedForm("A8a", "side on a horizontal brace, pushed by 2 kN", "pushed_side", SIDE, 1e6, push=2e3),
    ClosedForm("A8b", "the same, pushed by 10 kN", "pushed_side", SIDE, 1e6, push=1e4),
)


@dataclass(frozen=True)
class Series:
    """A hit on elastic ice that crushes, and its closed form in series."""

    name: str
    what: str
    hit: hits.Hit
    expected: Expected


ELASTIC = "ice.elastic_modulus=1e9"


def in_series(model: str) -> list[Series]:
    """A5, A7 and A9 with the elastic law of a model at 1 GPa, which takes the place of a linear spring."""
    chosen = (ELASTIC, f"contact.model={model}")
    found = []
    face = ClosedForm("A5", "face on a wall, 1 MPa, 3 m/s", "face_on_wall", face_on_wall(HEIGHT, 2.8), 1e6, speed=3.0)
    sides = [
        ClosedForm(name, f"side on the pile, {p:g} MPa", "side_on_pile", SIDE, 1e6 * p) for name, p in (("A7a", 1), ("A7b", 2))
    ]
    for each in (face, *sides):
        law = hits.elastic(each.case, *each.settings(*chosen), deepest=DEEPEST[model])
        hit = each.hit(*chosen)
        found.append(Series(each.name, each.what, hit, series(each.crushing, law, hit.mass, each.speed)))
    first, law = sides[0], hits.elastic("side_on_pile", *chosen, deepest=DEEPEST[model])
    for speed in (0.1, 0.3, 0.4):
        simulation = hits.begin(hits.case_of("side_on_pile", *first.settings(*chosen)))
        start = hits.follow(simulation).depth
        hit = hits.again(simulation, speed)
        expected = series(first.crushing, law, hit.mass, speed, start)
        found.append(Series("A9", f"a second hit on the same place after A7a, {speed:g} m/s", hit, expected))
    return found
