"""What a law says of the normal part of a contact."""

from typing import NamedTuple


class Pressed(NamedTuple):
    """One contact, pressed: numbers, and vectors as three of them, from the centroid of a where they are places."""

    mode: int
    size: float  # m or m2, of the patch; 1 for a contact at a point
    overlap: float  # m
    point: tuple  # m, of application of the force
    direction: tuple  # unit vector of the normal force on b
    normal_force: float  # N
    elastic_power: float  # W that the elastic part takes up
    damping_power: float  # W that damping takes up
    shear_stiffness: float  # N/m, of the spring of friction
    dashpot: float  # N s/m, beside that spring before `stiffness_ratio` scales it; 0: none, and nothing asks for the last two
    stored: float  # J
    gain: float  # J that the law made in the last step
    crumbled: float  # J that crushing cost in the last step
    velocity: tuple  # m/s, of b against a at the point, now
    turning: tuple  # rad/s, of b against a, now
