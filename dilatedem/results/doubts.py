"""Whether the energies of a run can be what its coefficients say, by summary.json; what to do where they cannot."""

from __future__ import annotations

from typing import Any

from dilatedem.numerics.balance import FREE_FLIGHT

#: share of what contacts lost that their laws may make, or take, besides
LARGEST_GAIN = 0.1
#: share of the energy turned over that the ledger may leave unexplained; of it, too, what laws make is too little to matter
LARGEST_RESIDUAL = 0.001


def doubts(summary: dict[str, Any]) -> list[str]:
    """A sentence for each thing about the energies that makes a run's loads doubtful, with the way on; none where all is well."""
    energy, contact = (amounts(summary.get(key)) for key in ("energy", "contact"))
    return [sentence for sentence in (doubt_of_laws(energy), doubt_of_residual(energy, contact.get("model"))) if sentence]


def amounts(part: Any) -> dict[str, Any]:
    """A table of a summary without what is null; nothing where it is no table."""
    return {key: value for key, value in part.items() if value is not None} if isinstance(part, dict) else {}


def doubt_of_laws(energy: dict[str, Any]) -> str:
    """What the contact laws made or took by themselves, once that passes a tenth of what contacts lost."""
    gain = energy.get("gain_law_J", 0.0)
    lost = sum(energy.get(f"loss_{way}_J", 0.0) for way in ("damping", "friction", "crushing"))
    limit = max(LARGEST_GAIN * lost, LARGEST_RESIDUAL * energy.get("turned_over_J", 0.0))
    if abs(gain) <= limit:
        return ""
    beside = f", {100.0 * abs(gain) / lost:.2g} % of the {joule(lost)} lost in contacts" if lost > 0.0 else ""
    return (
        f"the contact laws themselves {'made' if gain > 0.0 else 'took'} {joule(abs(gain))} (gain_law){beside}, so that hits and "
        'loads are not what the coefficients say; try contact.model = "consistent", which makes none, or a smaller '
        "time.step_fraction"
    )


def doubt_of_residual(energy: dict[str, Any], model: str | None) -> str:
    """What the ledger leaves unexplained, once that passes a thousandth of the energy turned over."""
    share = energy.get("residual_over_turned_over")
    in_flight = FREE_FLIGHT * energy.get("kinetic_J", 0.0)
    if share is None or share <= LARGEST_RESIDUAL or energy["residual_J"] <= in_flight:
        return ""
    other = "" if model == "consistent" else ' or contact.model = "consistent"'
    return (
        f"the energy ledger leaves {joule(energy['residual_J'])} unexplained, {100.0 * share:.2g} % of the "
        f"{joule(energy['turned_over_J'])} turned over, more than the {100.0 * LARGEST_RESIDUAL:g} % of a sound run; try a smaller "
        f"time.step_fraction{other}"
    )


def joule(energy: float) -> str:
    """An energy [J] in a unit that suits it."""
    for divisor, unit in ((1e6, "MJ"), (1e3, "kJ")):
        if energy >= divisor:
            return f"{energy / divisor:.3g} {unit}"
    return f"{energy:.3g} J"
