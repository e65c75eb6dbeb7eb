"""What a field of ice is, in numbers: what was asked for beside what came about."""

import math
from dataclasses import asdict

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.field.distribution import Moments
from dilatedem.scene.place import Scene

#: quantiles of floe sizes that are told
QUANTILES = (0.1, 0.5, 0.9)


def field_facts(case: Case, scene: Scene) -> dict:
    """What field.json says: counts, concentration, sizes (square roots of plan areas), thicknesses and seed."""
    domain_area = math.prod(case.domain.size)
    generated, listed = case.field.source == "voronoi", case.field.source == "bodies"
    field = scene.field
    areas = scene.plan_area if listed else field.floe_area
    return {
        "source": case.field.source,
        "seed": case.field.seed if generated else None,
        "count": len(areas),
        **({} if listed or len(areas) == len(field.outlines) else {"parts": len(field.outlines)}),
        "explicit_bodies": scene.explicit,
        "left_out_at_structures": field.left_out,
        "concentration_asked": case.field.concentration if generated else None,
        "concentration": float(areas.sum() / domain_area) if listed else field.concentration,
        "concentration_without_left_out": float(areas.sum() / domain_area),
        "floe_size_m": {"asked": case.field.asked_size if generated else None, **_sizes(areas)},
        **(_recipe(case) if generated else {}),
        **distribution_facts(case, scene),
        **file_facts(case, scene),
        **thickness_facts(case, scene),
    }


def _sizes(areas: np.ndarray) -> dict:
    """Of floes of plan areas (n,) [m2]."""
    names = ("root_of_mean_area", "mean", "median", "min", "max", "deviation")
    if not len(areas):
        return dict.fromkeys(names)
    size, moments = np.sqrt(areas), Moments.of_areas(areas)
    values = (moments.root_of_mean_area, moments.mean, np.median(size), size.min(), size.max(), moments.deviation)
    return dict(zip(names, map(float, values), strict=True))


def _recipe(case: Case) -> dict:
    field = case.field
    return {"shape": field.shape, "regularity": field.regularity, "front": field.front}


def asked_areas(case: Case, scene: Scene) -> np.ndarray | None:
    """(n,) [m2] plan areas that all floes which were made are asked to have, ascending; None where nothing is asked of them."""
    distribution, areas = case.field.size_distribution, scene.field.every_area
    if distribution is None or not len(areas):
        return None
    return _asked(case, areas).root_of_mean_area**2 * distribution.shares(len(areas))


def _asked(case: Case, areas: np.ndarray) -> Moments:
    return case.field.size_distribution.moments(case.field.asked_size or float(np.sqrt(areas.mean())))


def distribution_facts(case: Case, scene: Scene) -> dict:
    """Of the sizes of all floes that were made, also of those left out since: what was asked for, what was reached."""
    areas, asked = scene.field.every_area, asked_areas(case, scene)
    if asked is None:
        return {}
    told = {"kind": case.field.size_distribution.kind}
    for name, moments, all_areas in (("asked_m", _asked(case, areas), asked), ("reached_m", Moments.of_areas(areas), areas)):
        quantiles = np.sqrt(np.quantile(all_areas, QUANTILES))
        told[name] = asdict(moments) | {f"quantile_{q:g}": float(value) for q, value in zip(QUANTILES, quantiles, strict=True)}
    return {"size_distribution": told}


def file_facts(case: Case, scene: Scene) -> dict:
    """Of a field of outlines of a file: what was changed in them."""
    return {} if scene.report is None else {"file": {"path": case.field.file, **scene.report.facts()}}


def thickness_facts(case: Case, scene: Scene) -> dict:
    """Of the generated floes, where they are not all of one thickness."""
    thickness = scene.ice.thickness
    if not len(thickness) or (case.ice.thickness_spread == 0.0 and np.ptp(thickness) == 0.0):
        return {}
    return {
        "thickness_m": {
            "asked": case.ice.thickness,
            "mean": float(thickness.mean()),
            "spread_asked": case.ice.thickness_spread,
            "spread": float(thickness.std() / thickness.mean()),
            "min": float(thickness.min()),
            "max": float(thickness.max()),
        }
    }
