"""What the page is written from: numbers of both runs, kept in a file, so that the page can be written anew without them."""

import json
import math
from pathlib import Path

import numpy as np
import shapely

from dilatedem.results.load import load
from validation.hour.runs import MEMORY, SPEED, differing, in_parts, processor_time, whole

RECORD = Path(__file__).parent / "record.json"
#: s at the start that are left out: until then ice that starts undisturbed runs past the pile, and a wedge builds up ahead of it
RISE = 240.0
#: s of the blocks that bands are made from; several floes pass in one
BLOCK = 70.0
QUARTERS = 4
#: m, x between which the ice upstream is weighed, and snapshots before and after one that are weighed with it
BAND, BESIDE = (-40.0, -25.0), 3
#: significant digits that are kept
DIGITS = 6


def measured(folder: Path) -> dict:
    """The numbers of the runs in a folder, those made that are not there, as RECORD holds them from then on."""
    folder.mkdir(parents=True, exist_ok=True)
    out, parts = whole(folder), in_parts(folder)
    run = load(out)
    hits, summary, (times, shares) = run.hits, run.summary, upstream(run)
    hits = hits[hits.structure == "pile"]
    record = {
        "processor_s": processor_time(folder), "steps": summary["steps"], "simulated_s": summary["simulated_s"],
        "inflow": summary["inflow"], "residual_over_work": summary["energy"]["residual_over_work"],
        "differing": differing(out, parts), "upstream": [times, shares], "blocks": blocks(run.forces, summary["simulated_s"]),
        "hits": [hits.peak_time_s, hits.peak_N], "memory": json.loads((folder / MEMORY).read_text()),
    }  # fmt: skip
    return _kept(record)


def timed(folder: Path) -> dict:
    """The numbers that are kept, with the processor time as it is found now."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / SPEED).unlink(missing_ok=True)
    return _kept(json.loads(RECORD.read_text()) | {"processor_s": processor_time(folder)})


def recorded() -> dict:
    """What RECORD holds."""
    record = json.loads(RECORD.read_text())
    return record | {name: np.array(record[name], float) for name in ("upstream", "blocks", "hits", "memory")}


def _kept(record: dict) -> dict:
    lines = [f"{json.dumps(name)}: {json.dumps(_shortened(value), separators=(',', ':'))}" for name, value in record.items()]
    RECORD.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    return recorded()


def _shortened(value):
    """The same with as many digits as are kept, and no arrays in it."""
    if isinstance(value, dict):
        return {name: _shortened(part) for name, part in value.items()}
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    return value if isinstance(value, int | str | type(None)) else [_shortened(part) for part in np.asarray(value).tolist()]


def upstream(run) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) [s] of the snapshots, and the concentration upstream.

    In slices of a metre across the drift, weighed by a squared cosine over the band, and by another over the snapshots beside: of
    the ice that goes by. Sharp ends would cut floes in halves, and say more about these than about the ice. Outlines of the
    snapshots are those of prisms of equal volume, which cover a little less than the floes do; that is made up for.
    """
    last = run.snapshot(run.summary["simulated_s"])
    drawn = np.array([shapely.Polygon(outline).area for outline in last.outlines])
    rounded = run.floes.loc[last.body, "plan_area_m2"].to_numpy().sum() / drawn.sum()
    edges = np.linspace(*BAND, round(BAND[1] - BAND[0]) + 1)
    weight = bell(len(edges) - 1)
    slices = shapely.box(edges[:-1], -25.0, edges[1:], 25.0)
    times, shares = np.arange(0.0, run.summary["simulated_s"] + 1.0, run.case["output"]["snapshot_interval"]), []
    for time in times:
        ice = np.array([shapely.Polygon(outline) for outline in run.snapshot(time).outlines])
        ice = np.concatenate([shapely.transform(ice, lambda xy, by=y: xy + [0.0, by]) for y in (-50.0, 0.0, 50.0)])
        near, which = shapely.STRtree(slices).query(ice)
        covered = np.zeros(len(slices))
        np.add.at(covered, which, shapely.area(shapely.intersection(ice[near], slices[which])))
        shares.append(rounded * float(weight @ covered / 50.0))
    return times[BESIDE:-BESIDE], np.convolve(shares, bell(2 * BESIDE + 1), "valid")


def bell(count: int) -> np.ndarray:
    """(count,) weights that fall off to nothing as a squared cosine does; they add up to 1."""
    weight = np.cos(math.pi * ((np.arange(count) + 0.5) / count - 0.5)) ** 2
    return weight / weight.sum()


def blocks(forces, duration: float) -> np.ndarray:
    """(quarters, blocks, 2) [N] of the load on the pile: its mean along the current, and its highest, of every block."""
    count = int((duration - RISE) / QUARTERS / BLOCK)
    rows = forces[forces.structure == "pile"]
    number = np.floor((rows.time_s.to_numpy() - RISE - 1e-6) / BLOCK).astype(int)
    found = np.zeros((QUARTERS * count, 2))
    for k in range(QUARTERS * count):
        some = rows[number == k]
        found[k] = some.fx_N.mean(), some.fh_max_N.max()
    return found.reshape(QUARTERS, count, 2)
