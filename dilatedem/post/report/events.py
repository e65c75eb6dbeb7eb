"""Load events of hits.csv as a report tells them."""

from __future__ import annotations

from typing import Any

import numpy as np

from dilatedem.post.labels import kilo, number
from dilatedem.post.loads import PRESSURES
from dilatedem.post.read import RunFolder

#: of the load events on a structure, the highest are listed
EVENTS_LISTED = 10


def event_rows(run: RunFolder, structure: str) -> list[list[str]]:
    """The highest load events of a structure, one a row."""
    hits = run.hits.get(structure, {})
    highest = np.argsort(-hits["peak_N"], kind="stable")[:EVENTS_LISTED] if hits else []
    return [
        [
            number(float(hits["peak_time_s"][k]), 6), kilo(float(hits["peak_N"][k])), number(1e3 * float(hits["rise_s"][k]), 3),
            number(float(hits["duration_s"][k]), 3), kilo(float(hits["impulse_Ns"][k])), str(int(hits["body"][k])),
            str(hits["mode"][k]), number(float(hits["area_m2"][k]), 3), number(float(hits["pressure_Pa"][k]) / 1e6, 3),
            number(1e3 * float(hits["crushed_m"][k]), 3), str(int(hits["bodies"][k])),
        ]
        for k in highest
    ]  # fmt: skip


def pressure_words(run: RunFolder, structure: str, statistics: dict[str, Any]) -> str:
    """How many events would crush ice, and what that means; nothing where no event was told."""
    hits = statistics.get("hits", {})
    if structure not in run.hits or "share_above_1_MPa" not in hits:
        return ""
    shares = ", ".join(f"{number(100.0 * hits[f'share_above_{limit}_MPa'], 3)} % above {limit} MPa" for limit in PRESSURES)
    meaning = (run.summary.get("hits") or {}).get("meaning", "")
    return f"Of the {hits['count']} load events {shares}: {meaning}."
