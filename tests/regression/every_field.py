"""Prints digests of fields of all recipes, under the environment that `test_every_field` gives."""

import hashlib

import numpy as np

from dilatedem.field.distribution import Lognormal, PowerLaw, thicknesses
from dilatedem.field.placement import ice_field
from dilatedem.field.recipe import Recipe

RECIPES = {
    "lloyd": Recipe(regularity=3),
    "power law": Recipe(sizes=PowerLaw(kind="power_law", exponent=1.9, min=1.0, max=9.0)),
    "lognormal": Recipe(sizes=Lognormal(kind="lognormal", spread=0.4), regularity=1),
    "square": Recipe("square"),
    "hexagon": Recipe("hexagon"),
}


def main() -> None:
    for name, recipe in RECIPES.items():
        field = ice_field((50.0, 40.0), 300, 0.8, periodic=(False, True), seed=4, dilated_radius=0.02, recipe=recipe)
        print(name, hashlib.sha256(field.outlines.points.tobytes()).hexdigest()[:16])
    print("thickness", hashlib.sha256(thicknesses(300, 0.5, 0.3, np.random.default_rng(1)).tobytes()).hexdigest()[:16])


if __name__ == "__main__":
    main()
