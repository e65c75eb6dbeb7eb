"""The contact models side by side: each gives the stiffness and the damping of a contact mode."""

from dilatedem.contact.liu2015 import damping_coefficient, normal_stiffness
from dilatedem.jit import device


@device
def elastic_law(model, mode, modulus, first, second, size, sine):
    """Stiffness K [N/m^kappa] and exponent kappa of F = K overlap^kappa. Arguments as in `liu2015.normal_stiffness`.

    model: a ContactModel; `liu2015` is the one so far.
    """
    return normal_stiffness(mode, modulus, first, second, size, sine)


@device
def damping_force(model, damping, mass, stiffness, exponent, overlap, approach):
    """Viscous part of the normal force [N] at an approach speed [m/s]: second term of Liu 2015, Eq. (3), with Eq. (4)."""
    return damping_coefficient(damping, mass, stiffness) * power(overlap, exponent - 1.0) * approach


@device
def power(overlap, exponent):
    """overlap^exponent; the exponents that occur need no general power."""
    if exponent == 1.5:
        return overlap * overlap**0.5
    if exponent == 0.5:
        return overlap**0.5
    if exponent == 1.0:
        return overlap
    if exponent == 0.0:
        return 1.0
    return overlap**exponent


@device
def stored_energy(stiffness, exponent, overlap):
    """Elastic energy [J] of F = K overlap^kappa."""
    return stiffness * overlap * power(overlap, exponent) / (exponent + 1.0)
