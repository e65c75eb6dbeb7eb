"""The generated ice of a case: floes in plan, and what each is made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.field.distribution import thicknesses
from dilatedem.field.obstacles import Obstacle
from dilatedem.field.placement import FloeField, ice_field
from dilatedem.geometry import outline as plan
from dilatedem.scene.recipe import periodic_axes, ragged_axes, recipe_of, whole_axes
from dilatedem.scene.room import generated_floes
from dilatedem.structures.kind import Structure

#: of the two sequences of random numbers of a seed, that of thicknesses: with them or without, the field is the same in plan
THICKNESS = 1


@dataclass(frozen=True, eq=False)
class IceProperties:
    """Of n floes: thickness [m], density [kg/m3], elastic_modulus [Pa], poisson_ratio, all (n,), and velocity (n, 3) [m/s]."""

    thickness: np.ndarray
    density: np.ndarray
    elastic_modulus: np.ndarray
    poisson_ratio: np.ndarray
    velocity: np.ndarray

    @classmethod
    def of_case(cls, case: Case, count: int) -> IceProperties:
        """What floes have that say nothing of their own."""
        ice, velocity = case.ice, case.ice.initial_velocity
        if velocity == "current":
            velocity = (*case.water.velocity, 0.0) if case.water.enabled else (0.0, 0.0, 0.0)
        each = [np.full(count, value) for value in (ice.thickness, ice.density, ice.elastic_modulus, ice.poisson_ratio)]
        return cls(*each, np.tile(np.array(velocity, float), (count, 1)))

    def where(self, wanted: np.ndarray) -> IceProperties:
        """Of those floes that are `wanted` (n,), a mask."""
        return IceProperties(*(getattr(self, field.name)[wanted] for field in fields(self)))


def floes_of(case: Case, structures: Sequence[Structure], bodies: Sequence[Obstacle]) -> tuple[FloeField, IceProperties]:
    """The generated floes of a case, clear of structures and explicit bodies. Raises ValueError or CaseError if they cannot be."""
    if case.field.source == "bodies":
        nothing = np.zeros(0)
        return FloeField(plan.Outlines.of([]), nothing, nothing, 1.0, 0.0, nothing.astype(bool)), IceProperties.of_case(case, 0)
    count, recipe = generated_floes(case), recipe_of(case)
    ice = _varied(case, IceProperties.of_case(case, recipe.count(case.domain.size, count, whole_axes(case))))
    thickest = float(ice.thickness.max())
    field = ice_field(
        case.domain.size,
        count,
        case.field.concentration,
        periodic=periodic_axes(case),
        seed=case.field.seed,
        dilated_radius=case.ice.dilated_radius,
        obstacles=[*(obstacle for structure in structures for obstacle in structure.obstacles(thickest)), *bodies],
        recipe=recipe,
        ragged=ragged_axes(case),
    )
    return field, ice.where(field.kept)


def _varied(case: Case, ice: IceProperties) -> IceProperties:
    """The same with the thicknesses that the case asks for. Raises ValueError for one that its rounded edges do not fit into."""
    mean, spread, least = case.ice.thickness, case.ice.thickness_spread, 2.0 * case.ice.dilated_radius
    if spread == 0.0:
        return ice
    generator = np.random.default_rng([case.field.seed, THICKNESS])
    thickness = thicknesses(len(ice.thickness), mean, spread, generator)
    if thin := int(np.count_nonzero(thickness <= least)):
        raise ValueError(
            f"{thin} of {len(thickness)} floes are thinner than twice the dilated radius, {least:g} m, the thinnest "
            f"{thickness.min():.3g} m: take a smaller ice.thickness_spread or ice.dilated_radius"
        )
    return IceProperties(thickness, ice.density, ice.elastic_modulus, ice.poisson_ratio, ice.velocity)
