"""Waves too short for floes, or that do not fit between periodic sides, are warned of; waves and tables may move ice anywhere."""

import pytest

from dilatedem.case.load import case_from
from dilatedem.run.foretell import check
from dilatedem.run.simulation import Simulation

BODY = {"outline": [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]}
LENGTH = 9.81 * 9.0 / (2.0 * 3.141592653589793)  # of a wave of 3 s, 14.05 m


def case_of(waves: list[dict], size=(3.0 * LENGTH, 40.0), boundary: str = "open", **more):
    domain = {"size": list(size), "x_boundary": boundary}
    return case_from({"domain": domain, "field": {"source": "bodies"}, "body": [BODY], "wave": waves, **more}, {})


def advice(*arguments, **more) -> list[str]:
    return Simulation.of_case(case_of(*arguments, **more)).advice()


def test_floes_that_are_too_long_for_a_wave():
    assert advice([{"amplitude": 0.1, "period": 3.0}]) == []
    (said,) = advice([{"amplitude": 0.1, "period": 3.0}, {"amplitude": 0.01, "period": 2.0}])
    assert said.startswith("wave.1 is 6.25 m long, and floes are up to 2.8")


@pytest.mark.parametrize(("direction", "size", "said"), [
    (0.0, 3.0 * LENGTH, None),
    (180.0, 3.0 * LENGTH, None),
    (90.0, 40.0, None),
    (0.0, 2.4 * LENGTH, "wave.0 has 2.4 crests along x, where the domain repeats: floes beside the seam are out of step; "
                        "domain.size.0 = 28.104 fits"),
    (60.0, 2.0 * LENGTH, None),
])  # fmt: skip
def test_crests_that_do_not_meet_across_a_side(direction, size, said):
    wave = {"amplitude": 0.1, "period": 3.0, "direction": direction}
    assert advice([wave], (size, 40.0)) == []
    assert advice([wave], (size, 40.0), "periodic") == ([said] if said else [])


def test_a_structure_may_be_met_whatever_a_table_says_first():
    pile = {"structure": [{"kind": "pile", "center": [-10.0, 0.0], "radius": 1.0}]}
    (said,) = advice([], **pile)
    assert "all ice starts downstream of it" in said
    for more in (
        {"water": {"velocity_table": [[0.0, 0.3, 0.0], [50.0, -0.3, 0.0]]}},
        {"wind": {"velocity_table": [[0.0, 0.0, 0.0], [50.0, -9.0, 0.0]]}}, {"wave": [{"amplitude": 0.1, "period": 3.0}]},
    ):  # fmt: skip
        case = case_from({"domain": {"size": [40.0, 40.0]}, "field": {"source": "bodies"}, "body": [BODY], **pile, **more}, {})
        assert Simulation.of_case(case).advice() == []


def test_check_tells_the_length_of_a_wave():
    assert check(case_of([{"amplitude": 0.1, "period": 3.0}]))["length of wave.0, m"] == pytest.approx(LENGTH)
