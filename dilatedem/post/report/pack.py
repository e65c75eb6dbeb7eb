"""Numbers for the scripts of a page: arrays as base64 in JSON that can stand in HTML."""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np

#: largest value of a 16-bit number; arrays are scaled to it
FULL = 32767


def pack(values: np.ndarray, kind: str) -> str:
    """An array as base64 of little-endian numbers: kind `f4`, `i2`, `u2` or `u1`; the script has the same words."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=f"<{kind}").tobytes()).decode()


def scaled(values: np.ndarray, scale: float) -> str:
    """Values in units of a scale as 16-bit numbers, to the nearest."""
    return pack(np.clip(np.round(values / scale), -FULL, FULL), "i2")


def as_json(content: Any) -> str:
    """JSON that may stand inside a script element, whatever names it holds."""
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
