"""Words and units for the keys of a case, and how its values are written for a reader."""

from __future__ import annotations

import math
from typing import Any

# key of the case file (list positions left out) -> (what it is, unit)
KEYS: dict[str, tuple[str, str]] = {
    "domain.size": ("domain size", "m"),
    "domain.wall_friction": ("friction coefficient of the walls", ""),
    "field.floe_size": ("mean floe size", "m"),
    "field.floe_count": ("number of floes", ""),
    "field.concentration": ("ice concentration", ""),
    "field.seed": ("seed of the ice field", ""),
    "field.source": ("where the floes come from", ""),
    "field.file": ("file of outlines", ""),
    "field.sha256": ("SHA-256 of the file of outlines", ""),
    "field.scale": ("metres per unit of the file of outlines", ""),
    "field.origin": ("place of the file's origin", "m"),
    "field.not_convex": ("floes that are not convex", ""),
    "field.tolerance": ("tolerance of thinned outlines", "m"),
    "field.smallest": ("size of the smallest floe of a file", "m"),
    "field.shape": ("shape of the floes", ""),
    "field.regularity": ("regularity of the ice field", ""),
    "field.front": ("ends of the ice field", ""),
    "field.size_distribution.kind": ("distribution of floe sizes", ""),
    "field.size_distribution.exponent": ("exponent of the distribution of floe sizes", ""),
    "field.size_distribution.min": ("size of the smallest floe", "m"),
    "field.size_distribution.max": ("size of the largest floe", "m"),
    "field.size_distribution.spread": ("spread of floe sizes", ""),
    "ice.density": ("density of the ice", "kg/m³"),
    "ice.thickness": ("ice thickness", "m"),
    "ice.thickness_spread": ("spread of the ice thickness", ""),
    "ice.dilated_radius": ("dilated radius", "m"),
    "ice.elastic_modulus": ("elastic modulus of the ice", "Pa"),
    "ice.poisson_ratio": ("Poisson ratio of the ice", ""),
    "ice.crushing_pressure": ("crushing pressure of the ice", "Pa"),
    "ice.crushing_exponent": ("exponent of the crushing pressure", ""),
    "ice.flexural_strength": ("flexural strength of the ice", "Pa"),
    "ice.initial_velocity": ("initial speed of the ice", "m/s"),
    "water.density": ("density of the water", "kg/m³"),
    "water.velocity": ("current speed", "m/s"),
    "water.velocity.0": ("current along x", "m/s"),
    "water.velocity.1": ("current along y", "m/s"),
    "water.velocity_file": ("table of the current", ""),
    "water.shear": ("current against depth", ""),
    "water.drag": ("drag law of the water", ""),
    "water.drag_force_coefficient": ("drag force coefficient", ""),
    "water.drag_moment_coefficient": ("drag moment coefficient", ""),
    "water.skin_coefficient": ("skin drag coefficient of the water", ""),
    "water.form_coefficient": ("form drag coefficient of the water", ""),
    "water.added_mass": ("added mass of the water", ""),
    "wind.velocity": ("wind speed", "m/s"),
    "wind.velocity_file": ("table of the wind", ""),
    "wind.density": ("density of the air", "kg/m³"),
    "wind.skin_coefficient": ("skin drag coefficient of the wind", ""),
    "wind.form_coefficient": ("form drag coefficient of the wind", ""),
    "wave.amplitude": ("wave amplitude", "m"),
    "wave.period": ("wave period", "s"),
    "wave.direction": ("wave direction", "°"),
    "wave.phase": ("wave phase", "°"),
    "wave.rise": ("time over which the wave rises", "s"),
    "gravity.acceleration": ("gravity", "m/s²"),
    "structure.center": ("centre", "m"),
    "structure.radius": ("radius", "m"),
    "structure.waterline_radius": ("radius at the water level", "m"),
    "structure.size": ("length along its axes", "m"),
    "structure.rotation": ("rotation (of a box in °, of a mesh in rad)", ""),
    "structure.bottom": ("height of the lower side", "m"),
    "structure.top": ("height of the upper side", "m"),
    "structure.dilated_radius": ("radius of its edges", "m"),
    "structure.point": ("point of the plane", "m"),
    "structure.from": ("one end of the axis", "m"),
    "structure.to": ("other end of the axis", "m"),
    "structure.outline": ("outline at the water level", "m"),
    "structure.slope": ("slope of the sides from the horizontal", "°"),
    "structure.file": ("surface mesh", ""),
    "structure.sha256": ("SHA-256 of the surface mesh", ""),
    "structure.scale": ("metres per unit of the mesh", ""),
    "structure.position": ("place of the mesh's origin", "m"),
    "structure.elastic_modulus": ("elastic modulus of the structure", "Pa"),
    "structure.poisson_ratio": ("Poisson ratio of the structure", ""),
    "structure.friction": ("friction coefficient of the structure", ""),
    "structure.support.kind": ("what carries the structure", ""),
    "structure.support.velocity": ("velocity of the structure", "m/s"),
    "structure.support.velocity.0": ("velocity of the structure along x", "m/s"),
    "structure.support.velocity.1": ("velocity of the structure along y", "m/s"),
    "structure.support.turning": ("angular velocity of the structure", "rad/s"),
    "structure.support.file": ("table of the motion of the structure", ""),
    "structure.support.mass": ("moving mass of the structure", "kg"),
    "structure.support.stiffness": ("stiffness of the support", "N/m"),
    "structure.support.damping_ratio": ("damping ratio of the support", ""),
    "structure.support.damping": ("dashpots of the support", "N s/m"),
    "structure.support.inertia": ("moment of inertia of the structure", "kg m²"),
    "structure.support.stiffness_yaw": ("stiffness of the support about z", "N m/rad"),
    "structure.support.damping_yaw": ("dashpot of the support about z", "N m s"),
    "structure.support.length": ("length of the beam below the water", "m"),
    "structure.support.length_above": ("length of the beam above the water", "m"),
    "structure.support.mass_per_length": ("mass per length of the beam", "kg/m"),
    "structure.support.bending_stiffness": ("bending stiffness of the beam", "N m²"),
    "structure.support.deck_mass": ("mass on top of the beam", "kg"),
    "structure.support.soil_stiffness": ("stiffness of the soil, sideways", "N/m"),
    "structure.support.soil_stiffness_turning": ("stiffness of the soil against tilting", "N m/rad"),
    "structure.support.push_height": ("height at which the ice pushes", "m"),
    "structure.support.modes": ("modes of the beam", ""),
    "contact.model": ("contact model", ""),
    "contact.damping": ("damping coefficient", ""),
    "contact.damping_law": ("damping law", ""),
    "deformation.modes": ("modes of each body", ""),
    "deformation.damping": ("damping ratio of modes", ""),
    "deformation.strains": ("whether uniform strains are added to the modes", ""),
    "deformation.mesh_size": ("size of the finite elements", "m"),
    "contact.friction": ("friction coefficient", ""),
    "contact.stiffness_ratio": ("stiffness ratio", ""),
    "time.duration": ("duration", "s"),
    "time.step": ("time step", "s"),
    "time.step_fraction": ("time step over the critical one", ""),
    "time.mode": ("what is sought", ""),
    "time.residual": ("out of balance at rest, over the largest load", ""),
    "time.until.ice_gone": ("ends when all ice is gone", ""),
    "time.until.load_above": ("ends at a load above", "N"),
    "time.until.steady": ("ends when the mean load is known to", ""),
    "output.snapshot_interval": ("snapshot interval", "s"),
    "output.force_interval": ("force interval", "s"),
    "output.energy_interval": ("energy interval", "s"),
    "output.track_interval": ("track interval", "s"),
    "output.checkpoint_interval": ("checkpoint interval", "s"),
    "output.moment_level": ("level of moments", "m"),
    "output.hit_threshold": ("least force of a load event", "N"),
    "output.hit_gap": ("gap between load events", "s"),
    "output.hits_in_full": ("load events kept at every step", ""),
}


def describe_key(key: str) -> tuple[str, str]:
    """(what the key is, unit); an unknown key is described by itself."""
    if key in KEYS:
        return KEYS[key]
    parts = key.split(".")
    if parts[0] in ("structure", "body", "wave") and len(parts) > 2 and parts[1].isdigit():
        if parts[2] == "part" and len(parts) > 4:
            parts = [parts[0], *parts[3:]]  # a part of a structure has the keys of one
        what, unit = describe_key(".".join([parts[0], *parts[2:]]))
        return (what if what != f"{parts[0]}.{parts[2]}" else key), unit
    if parts[-1].isdigit() and ".".join(parts[:-1]) in KEYS:
        what, unit = KEYS[".".join(parts[:-1])]
        return f"{what} [{parts[-1]}]", unit
    return key, ""


def axis_label(key: str) -> str:
    what, unit = describe_key(key)
    text = what[0].upper() + what[1:]
    return f"{text} ({unit})" if unit else text


def number(value: float, digits: int = 4) -> str:
    """A number for a reader: a few significant digits, no exponent while it stays readable."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    if value < 0.0:
        return "\N{MINUS SIGN}" + number(-value, digits)
    if 1e-3 <= value < 1e6:
        decimals = max(0, digits - 1 - math.floor(math.log10(value)))
        return without_zeros(f"{value:.{decimals}f}")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{without_zeros(mantissa)} × 10{str(int(exponent)).translate(SUPERSCRIPT)}"


def kilo(value: float) -> str:
    """A thousandth of a value."""
    return number(value / 1e3, 3)


def without_zeros(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def show(value: Any) -> str:
    """A value of a case as a reader wants it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\N{THIN SPACE}").replace("-", "\N{MINUS SIGN}")
    if isinstance(value, float):
        return number(value, 6)
    if isinstance(value, list | tuple):
        return ", ".join(show(entry) for entry in value) if value else "none"
    return "–" if value is None else str(value)


def flatten(case: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A case as one level of dotted keys; lists of tables are numbered, lists of numbers stay whole."""
    flat: dict[str, Any] = {}
    for key, value in case.items():
        name = f"{prefix}{key}"
        if isinstance(value, dict):
            flat |= flatten(value, f"{name}.")
        elif isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value):
            for index, entry in enumerate(value):
                flat |= flatten(entry, f"{name}.{index}.")
        else:
            flat[name] = value
    return flat
