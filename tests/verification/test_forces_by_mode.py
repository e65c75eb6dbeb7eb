"""Force of every contact mode of `liu2015` at an overlap of 0.1 mm: F = K delta^kappa, Liu 2015, Eqs. (10)-(13), (18), (19), (24).

r = 0.04 m, L = 0.5 m, A = 0.1 m2; ice (1 GPa, 0.3) on ice, on a steel pile of R = 2 m and on a flat steel plate (210 GPa,
0.3). Placed bodies, through the whole of distance, patch and law. The specification prints three digits (four for faces): it
is met to half of the last.
"""

import numpy as np
import pytest

from dilatedem.contact.liu2015.patch import RIM
from dilatedem.state.modes import Mode
from tests.verification.comparison import Comparison, check, start

OVERLAP = 1e-4
#: pair of bodies (b of a structure: its number after the bodies): name, mode, force [N] as specified, unit of its last digit
ON_ICE = {
    (0, 1): ("vertex-vertex", Mode.VERTEX_VERTEX, 104, 1),
    (2, 3): ("vertex-face", Mode.VERTEX_FACE, 147, 1),
    (4, 5): ("vertex-edge", Mode.VERTEX_EDGE, 123, 1),
    (6, 7): ("edges crossing at 90 degrees", Mode.EDGE_CROSSING, 147, 1),
    (8, 9): ("parallel edges", Mode.EDGE_PARALLEL, 51.8, 0.1),
    (10, 11): ("edge-face", Mode.EDGE_FACE, 73.3, 0.1),
    (12, 13): ("face-face", Mode.FACE_FACE, 20000, 10),
}
ON_STEEL = {
    (0, 7): ("vertex on the pile", Mode.VERTEX_EDGE, 290, 1),
    (1, 7): ("edge across the pile", Mode.EDGE_CROSSING, 776, 1),
    (2, 7): ("edge along the pile", Mode.EDGE_PARALLEL, 144, 1),
    (3, 7): ("flat side on the pile", Mode.EDGE_FACE, 1031, 1),
    (4, 8): ("vertex on the plate", Mode.VERTEX_FACE, 292, 1),
    (5, 8): ("edge on the plate", Mode.EDGE_FACE, 146, 1),
    (6, 8): ("face on the plate", Mode.FACE_FACE, 39810, 10),
}
CASES = {"forces_ice": ON_ICE, "forces_structure": ON_STEEL}


def evaluated(case: str) -> dict[tuple[int, int], dict]:
    """Mode, force (3,), overlap, size and normal of every open contact of a case at t = 0."""
    pairs = start(case).state.pairs
    return {
        (int(pairs.a[k]), int(pairs.b[k])): {
            name: np.array(getattr(pairs, name)[k]) for name in ("mode", "force", "overlap", "size", "normal", "point")
        }
        for k in np.flatnonzero(pairs.overlap[: pairs.count[0]] > 0.0)
    }


def compare() -> list[Comparison]:
    rows = []
    for case, expected in CASES.items():
        found = evaluated(case)
        for pair, (name, _, force, unit) in expected.items():
            result = float(np.linalg.norm(found[pair]["force"]))
            rows.append(Comparison(case, f"{name}: force, N", force, result, 0.5001 * unit / force, model="liu2015"))
    return rows


def test_forces():
    check(compare())


@pytest.mark.parametrize("case", CASES)
def test_modes_and_overlaps(case):
    found, expected = evaluated(case), CASES[case]
    assert {pair: Mode(int(contact["mode"])) for pair, contact in found.items()} == {p: row[1] for p, row in expected.items()}
    for contact in found.values():
        assert contact["overlap"] == pytest.approx(OVERLAP, rel=1e-9)
        # without damping and friction the force is along the normal
        assert contact["force"] == pytest.approx(np.linalg.norm(contact["force"]) * contact["normal"], rel=1e-9, abs=1e-9)


def test_patches_keep_their_size():
    # to the rim that every face has; no body there reaches farther than 1 m
    ice, steel = evaluated("forces_ice"), evaluated("forces_structure")
    for contact in (ice[8, 9], ice[10, 11], steel[2, 7], steel[3, 7], steel[5, 8]):
        assert contact["size"] == pytest.approx(0.5, abs=3 * RIM)
    for contact in (ice[12, 13], steel[6, 8]):
        assert contact["size"] == pytest.approx(0.1, abs=3 * RIM)
