"""Where two cases differ."""

from typing import Any


def differences(one: Any, other: Any, key: str = "") -> list[str]:
    """Dotted keys at which two cases, as plain tables and lists, hold different values."""
    if isinstance(one, dict) and isinstance(other, dict):
        names = dict.fromkeys([*one, *other])
        return [found for name in names for found in differences(one.get(name), other.get(name), f"{key}.{name}" if key else name)]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [found for i, pair in enumerate(zip(one, other, strict=True)) for found in differences(*pair, f"{key}.{i}")]
    return [] if one == other else [key]
