"""What whoever signs a report looks at first: whether the run is whole, its ledger closed, its step short, its ice bearable."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from dilatedem.post.labels import kilo, number
from dilatedem.post.loads import PRESSURES
from dilatedem.post.overview import status_words
from dilatedem.post.read import RunFolder
from dilatedem.results.doubts import LARGEST_GAIN, LARGEST_RESIDUAL, amounts, doubt_of_laws, doubt_of_residual

#: share of its highest load that half the step may change: less than seeds make of it by far
LARGEST_CHANGE = 0.01
#: the words of the three verdicts
FINE, LOOK, UNKNOWN = "holds", "look", "not known"


class Check(NamedTuple):
    """One question, what was found, what is asked of it, and the verdict."""

    what: str
    found: str
    asked: str
    verdict: str


def checks(run: RunFolder) -> list[Check]:
    """All that can be said of this run."""
    energy, contact = (amounts(run.summary.get(key)) for key in ("energy", "contact"))
    found = [_whole(run), _residual(energy, contact), _law(energy), _step(run), _half_step(run), _depth(run, contact)]
    found.append(_pressure(run))
    return [check for check in found if check is not None]


def verdict_words(found: list[Check]) -> str:
    """How many of the checks hold, and which ask for a look or were not made, for the front page."""
    held = sum(check.verdict == FINE for check in found)
    words = [f"{held} of {len(found)} checks hold."]
    for verdict, what in ((LOOK, "To be looked at, see Checks and Limits"), (UNKNOWN, "Not known")):
        named = [check.what for check in found if check.verdict == verdict]
        words += [f"{what}: {'; '.join(named)}."] if named else []
    return " ".join(words)


def _whole(run: RunFolder) -> Check:
    done = run.summary.get("status") == "completed"
    return Check("the run came to its end", status_words(run), "completed", FINE if done else LOOK)


def _residual(energy: dict[str, Any], contact: dict[str, Any]) -> Check | None:
    share = energy.get("residual_over_turned_over")
    if share is None:
        return None
    verdict = LOOK if doubt_of_residual(energy, contact.get("model")) else FINE
    asked = f"at most {number(100.0 * LARGEST_RESIDUAL)} %"
    return Check("the energy ledger closes: residual / energy turned over", f"{number(100.0 * share, 3)} %", asked, verdict)


def _law(energy: dict[str, Any]) -> Check | None:
    gain = energy.get("gain_law_J")
    if gain is None:
        return None
    lost = sum(energy.get(f"loss_{way}_J", 0.0) for way in ("damping", "friction", "crushing"))
    share = f", {number(100.0 * abs(gain) / lost, 3)} % of what contacts lost" if lost > 0.0 else ""
    verdict = LOOK if doubt_of_laws(energy) else FINE
    asked = f"at most {number(100.0 * LARGEST_GAIN)} % of that"
    return Check("energy made or taken by the contact laws themselves", f"{kilo(gain)} kJ{share}", asked, verdict)


def _step(run: RunFolder) -> Check | None:
    step, critical = run.summary.get("dt_s"), run.summary.get("dt_critical_s")
    if not step or not critical:
        return None
    found = f"{number(step / critical, 3)} ({number(1e3 * step, 3)} ms)"
    return Check("time step / critical time step", found, "less than 1", FINE if step < critical else LOOK)


def _half_step(run: RunFolder) -> Check:
    what, told = "change of the highest hit with half the time step", run.summary.get("error_check") or {}
    change = (told.get("change") or {}).get("fh_max")
    asked = f"at most {number(100.0 * LARGEST_CHANGE)} %"
    if change is None:
        return Check(what, told.get("message") or "not tried: time.error_check = true replays it", asked, UNKNOWN)
    verdict = FINE if abs(change) <= LARGEST_CHANGE else LOOK
    return Check(f"{what} (on {told.get('structure')})", f"{number(100.0 * change, 2)} %", asked, verdict)


def _depth(run: RunFolder, contact: dict[str, Any]) -> Check | None:
    """Contact laws take bodies for rounded ones: their cores must not meet."""
    deepest, radius = contact.get("largest_overlap_m"), run.case.get("ice", {}).get("dilated_radius")
    if deepest is None or not radius:
        return None
    found = f"{number(1e3 * deepest, 3)} mm"
    asked = f"less than {number(1e3 * radius)} mm, the dilated radius"
    return Check("deepest overlap of a contact", found, asked, FINE if deepest < radius else LOOK)


def _pressure(run: RunFolder) -> Check | None:
    """Of the leading contacts at the peaks of all load events."""
    if not run.hits:
        return None
    found = np.concatenate([hits["pressure_Pa"] for hits in run.hits.values()]) / 1e6
    above = [f"{number(100.0 * float(np.mean(found > limit)), 3)} % of the events above {limit} MPa" for limit in PRESSURES[:2]]
    asked = f"at most {PRESSURES[0]} MPa, or ice that crushes: it does at 1 to 3 MPa"
    crushes = run.case.get("ice", {}).get("crushing_pressure") is not None
    verdict = FINE if crushes or found.max() <= PRESSURES[0] else LOOK
    told = f"up to {number(float(found.max()), 3)} MPa; {', '.join(above)}"
    return Check("mean nominal pressure at the peaks", told, asked, verdict)
