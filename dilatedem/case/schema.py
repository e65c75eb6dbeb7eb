"""The case file as data: one field is one documented key, with its default, unit, bounds and meaning.

The docs (`docs/case-file.md`) and `dilatedem schema` are generated from this file. Everything here is frozen:
a case does not change once it was read.
"""

from typing import Annotated, Any, Literal, Union

from pydantic import Field, model_validator

from dilatedem.case.bodies import Body
from dilatedem.case.deformation import Deformation
from dilatedem.case.domain import Domain, inflow_faults
from dilatedem.case.field import IceField
from dilatedem.case.names import name_faults
from dilatedem.case.sea import Water, Wave, Wind, wave_faults
from dilatedem.case.time import Time
from dilatedem.case.until import Until, until_faults
from dilatedem.field import distribution
from dilatedem.keys import (
    Fault,
    Friction,
    NonNegative,
    PoissonRatio,
    Positive,
    Table,
    TomlJsonSchema,
    Vector3,
    complete,
    key,
)
from dilatedem.structures import kinds, support


def _dilation_faults(radius: float, thickness: float) -> list[Fault]:
    """A floe's core is its outer shape less the dilated radius on every side: it must not turn inside out."""
    if 2 * radius > thickness:
        return [(("dilated_radius",), f"must be at most half the thickness, {thickness / 2:g} m")]
    return []


class Ice(Table):
    """The floes' material and shape. Thickness and outline are outer sizes, dilation included."""

    density: Positive = key(915.0, "kg/m3", "Density of the ice.")
    thickness: Positive = key(0.5, "m", "Outer thickness of a floe; the mean where it varies.")
    thickness_spread: Annotated[float, Field(ge=0, le=1)] = key(
        0.0,
        "",
        "Standard deviation of the thickness of the generated floes over its mean; lognormal. Each floats at its own draught.",
    )
    dilated_radius: Positive = key(0.04, "m", "Radius by which a floe's edges and corners are rounded; at most half the thickness.")
    elastic_modulus: Positive = key(1.0e9, "Pa", "Young's modulus in contact.")
    poisson_ratio: PoissonRatio = key(0.3, "", "Poisson's ratio.")
    crushing_pressure: Positive | None = key(
        None,
        "Pa",
        "Pressure at which the ice crushes, on a nominal contact area of 1 m2: C of p = C (A/1 m2)^q; 1e6 to 3e6 is measured. "
        "Without it the ice bears any pressure, as in the paper.",
    )
    crushing_exponent: Annotated[float, Field(ge=-0.7, le=0)] = key(
        0.0, "", "q of p = C (A/1 m2)^q: how the pressure falls with the nominal area of a contact; 0: not at all."
    )
    flexural_strength: Positive = key(
        5.0e5, "Pa", "Tension that ice bears in bending: floes that bend, and are pulled by more, are marked, counted and listed."
    )
    initial_velocity: Literal["current"] | Vector3 = key(
        "current",
        "m/s",
        "Velocity of the generated floes at the start: `[u, v, w]`, or `current` for that of the water "
        "(at rest where the water is off).",
        allowed='must be "current" or a list of 3 numbers',
    )

    def faults(self) -> list[Fault]:
        return _dilation_faults(self.dilated_radius, self.thickness)


class Gravity(Table):
    """Uniform gravity."""

    acceleration: NonNegative = key(9.81, "m/s2", "Acceleration along -z; 0 switches gravity off.")


class Contact(Table):
    """The contact laws between floes and with structures."""

    model: Literal["liu2015", "consistent"] = key(
        "liu2015",
        "",
        "`liu2015`: the paper's laws, mode by mode; `consistent`: laws that agree with elasticity and with each other.",
    )
    damping: Annotated[float, Field(ge=0, le=100)] = key(0.36, "", "Damping coefficient of the normal force; 0 is elastic.")
    damping_law: Literal["viscous", "touch"] = key(
        "viscous",
        "",
        "Of `consistent`: a dashpot that acts from the first touch on, or one that vanishes there, so that loads rise from nothing "
        "as elastic ones do. `damping` gives both the same restitution. `liu2015` has the `viscous` one of the paper.",
    )
    friction: Friction = key(0.1, "", "Coefficient of friction; a structure may have its own.")
    stiffness_ratio: Annotated[float, Field(ge=0, le=1000)] = key(0.7, "", "Tangential over normal stiffness.")

    def faults(self) -> list[Fault]:
        if self.damping_law == "touch" and self.model != "consistent":
            return [(("damping_law",), f'must be "viscous" with contact.model = "{self.model}"; "touch" is for "consistent"')]
        return []


class Output(Table):
    """What is written, and how often in simulated time."""

    snapshot_interval: NonNegative = key(1.0, "s", "Between two VTU snapshots of the floes; 0 writes none.")
    force_interval: Positive = key(0.01, "s", "Window of one row of forces.csv.")
    energy_interval: Positive = key(0.1, "s", "Between two rows of energy.csv.")
    track: Literal["all"] | list[Annotated[int, Field(ge=0)]] = key(
        [],
        "",
        'Numbers of the bodies whose motion goes to bodies.csv, or `"all"`.',
        allowed='must be "all" or a list of body numbers, from 0',
    )
    track_interval: Positive = key(0.01, "s", "Between two rows of a tracked body in bodies.csv.")
    checkpoint_interval: NonNegative = key(
        10.0, "s", "Between two saved states, from which `--resume` goes on; 0 saves only where the run ends."
    )
    hit_threshold: Literal["auto"] | Positive = key(
        "auto",
        "N",
        "Horizontal force from which on a load is an event of hits.csv; `auto`: what would give the mean floe 1 m/s².",
        allowed='must be "auto" or a number greater than 0',
    )
    hit_gap: Positive = key(1.0, "s", "Time between two loads that count from which on they are two events.")
    hits_in_full: Annotated[int, Field(ge=0, le=100)] = key(
        5, "", "How many of the highest events are kept at every step in run.h5, with the floes that pushed."
    )
    moment_level: float = key(0.0, "m", "Height over the water level about which moments of the loads are stated.")

    def faults(self) -> list[Fault]:
        if self.track != "all" and len(set(self.track)) < len(self.track):
            return [(("track",), "names a body twice")]
        return []


class Case(Table):
    """A whole case: what `dilatedem run` simulates."""

    title: str = key("", "", "A line that says what the case is.")
    domain: Domain = Domain()
    field: IceField = IceField()
    ice: Ice = Ice()
    water: Water = Water()
    wind: Wind = Wind()
    wave: list[Wave] = []
    gravity: Gravity = Gravity()
    structure: list[Annotated[Union[kinds.KINDS], Field(discriminator="kind")]] = []  # noqa: UP007 (a union of a list of classes)
    contact: Contact = Contact()
    time: Time = Time()
    deformation: Deformation = Deformation()
    output: Output = Output()
    body: list[Body] = []

    @property
    def bends(self) -> bool:
        """Whether any body does: in machine code of its own."""
        return self.deformation.modes > 0 or any(body.modes for body in self.body)

    @property
    def laws(self) -> dict[str, Any]:
        """What decides which machine code a run needs: arguments of `run.loop.compile_kernels`."""
        crushing, tapers = self.ice.crushing_pressure is not None, any(structure.tapers for structure in self.structure)
        return {"model": self.contact.model, "crushing": crushing, "tapers": tapers, "sea": self.at_sea, "bends": self.bends}

    @property
    def at_sea(self) -> bool:
        """Whether water or wind vary, or floes take water along: more than the paper's loads, in machine code of its own."""
        return bool(self.wave) or self.water.varies or self.wind.velocity_table is not None

    def faults(self) -> list[Fault]:
        found = [*name_faults(self.structure, self.body), *self._body_faults(), *self._track_faults(), *self._check_faults()]
        drift = "water.velocity" if self.ice.initial_velocity == "current" else "ice.initial_velocity"
        found += inflow_faults(self.domain, self.field, self.ice_velocity, drift)
        found += wave_faults(self.wave, self.water.enabled, self.gravity.acceleration)
        return [*found, *self._field_faults(), *self._until_faults(), *self._bending_faults(), *self._rest_faults()]

    @property
    def ice_velocity(self) -> tuple[float, float, float]:
        """Velocity [m/s] of generated floes at the start, and where they enter."""
        if self.ice.initial_velocity != "current":
            return self.ice.initial_velocity
        return (*self.water.velocity, 0.0) if self.water.enabled else (0.0, 0.0, 0.0)

    @model_validator(mode="after")
    def _fill_bodies(self):
        """Bodies take from [ice] what they leave out, so that no reader of a case need know where to look."""
        complete(self, "body", [body.model_copy(update=self._from_ice(body)) for body in self.body])
        return self

    def _from_ice(self, body: Body) -> dict[str, Any]:
        names = ["dilated_radius", "density", "elastic_modulus", "poisson_ratio"]
        if body.outline is not None:
            names.append("thickness")
        values = {name: getattr(self.ice, name) for name in names if getattr(body, name) is None}
        if body.vertices is not None and body.position is None:
            values["position"] = (0.0, 0.0, 0.0)
        return values

    def _body_faults(self) -> list[Fault]:
        found: list[Fault] = []
        if self.field.source == "bodies" and not self.body:
            found.append((("field", "source"), "needs at least one [[body]]"))
        for i, body in enumerate(self.body):
            given = [name for name in ("dilated_radius", "thickness") if getattr(body, name) is not None]
            if body.outline is None or not given:
                continue  # without either of its own, [ice] has been compared already
            radius = body.dilated_radius if body.dilated_radius is not None else self.ice.dilated_radius
            thickness = body.thickness if body.thickness is not None else self.ice.thickness
            if "dilated_radius" not in given and 2 * radius > thickness:
                text = f"must be at least twice ice.dilated_radius, {2 * radius:g} m"
                found.append((("body", i, "thickness"), text))
            else:
                faults = _dilation_faults(radius, thickness)
                found += [(("body", i, *where), text) for where, text in faults]
        return found

    def _check_faults(self) -> list[Fault]:
        leaving = [kind for kind in ("outflow", "inflow") if kind in self.domain.boundaries]
        if self.time.error_check and leaving:
            text = f'must be false where a boundary is "{leaving[0]}": bodies that have left cannot be replayed; take "open"'
            return [(("time", "error_check"), text)]
        return []

    def _field_faults(self) -> list[Fault]:
        closed = ("periodic", "wall", "inflow")
        if self.field.front == "ragged" and self.domain.x_boundary in closed and self.domain.y_boundary in closed:
            return [(("field", "front"), 'must be "straight" where no side is open: ice ends nowhere')]
        return []

    def _bending_faults(self) -> list[Fault]:
        if not self.bends:
            return []
        rigid = "must be 0, of every body, where"
        if {"outflow", "inflow"} & set(self.domain.boundaries):
            return [(("deformation", "modes"), f"{rigid} bodies come or go")]
        if self.at_sea or self.field.source == "file":
            said = "there are waves, added mass, a current or wind that varies, or floes of a file"
            return [(("deformation", "modes"), f"{rigid} {said}")]
        return []

    def _rest_faults(self) -> list[Fault]:
        moves = any(structure.support.moves for structure in self.structure)
        if self.time.relaxes and (moves or self.at_sea or {"outflow", "inflow"} & set(self.domain.boundaries)):
            said = "structures move, bodies come or go, or water or wind vary"
            return [(("time", "mode"), f'must be "dynamic" where {said}: nothing comes to rest')]
        if self.time.relaxes and self.time.error_check:
            return [(("time", "error_check"), 'must be false where time.mode is "relax"')]
        return []

    def _until_faults(self) -> list[Fault]:
        current = self.water.velocity if self.water.enabled else (0.0, 0.0)
        standing = sum(structure.has_an_end for structure in self.structure)
        return until_faults(self.time.until, self.domain, current, standing)

    @property
    def endless(self) -> "Case":
        """The same case without what says when it ends: what is alike of a run and of a longer one."""
        never = self.time.model_copy(update={"duration": 1.0, "until": Until()})
        return self.model_copy(update={"time": never})

    def _track_faults(self) -> list[Fault]:
        # The number of generated floes is known only once the field was built, so that is checked there.
        if self.field.source != "bodies" or self.output.track == "all" or not self.body:
            return []
        beyond = [number for number in self.output.track if number >= len(self.body)]
        if not beyond:
            return []
        text = f"there is no body {beyond[0]}; they are numbered from 0 to {len(self.body) - 1}"
        return [(("output", "track"), text)]


TABLES: dict[str, type[Table]] = {
    name: field.annotation
    for name, field in Case.model_fields.items()
    if isinstance(field.annotation, type) and issubclass(field.annotation, Table)
}
#: what a case has any number of, besides structures
LISTED: dict[str, type[Table]] = {"wave": Wave, "body": Body}
STRUCTURES: dict[str, type[Table]] = dict(kinds.BY_NAME)
SUPPORTS: dict[str, type[Table]] = dict(support.BY_NAME)
DISTRIBUTIONS: dict[str, type[Table]] = dict(distribution.BY_NAME)


def table_of(path: tuple[str | int, ...], data: dict) -> tuple[type[Table], str] | None:
    """The table that the key at or around `path` belongs to, and the key; None where there is none.

    path : keys and list positions from the top, as in ("structure", 0, "radius").
    data : the case as read, not validated; it tells the kind of a structure, of its support and of a distribution.
    """
    if len(path) == 1:
        return Case, str(path[0])
    if path[:2] == ("field", "size_distribution") and len(path) > 2:
        try:
            return DISTRIBUTIONS[data["field"]["size_distribution"]["kind"]], str(path[2])
        except (KeyError, TypeError):
            return None
    if path[0] in TABLES:
        inner = TABLES[path[0]].model_fields.get(str(path[1]))
        if len(path) > 2 and inner is not None and isinstance(inner.default, Table):
            return type(inner.default), str(path[2])
        return TABLES[path[0]], str(path[1])
    if len(path) < 3 or path[0] not in ("structure", *LISTED):
        return None
    if path[0] in LISTED:
        return LISTED[path[0]], str(path[2])
    last = 4 if len(path) > 4 and path[2] == "part" else 2  # a key of a part, or of a structure
    try:
        table = data
        for step in path[:last]:
            table = table[step]
        if path[last] == "support" and len(path) > last + 1:
            return SUPPORTS[table["support"]["kind"]], str(path[last + 1])
        return STRUCTURES[table["kind"]], str(path[last])
    except (KeyError, IndexError, TypeError):
        return None


def json_schema() -> dict[str, Any]:
    """JSON Schema of the case file, for editors and other programs."""
    schema = Case.model_json_schema(schema_generator=TomlJsonSchema)
    return {"$schema": TomlJsonSchema.schema_dialect, **schema}
