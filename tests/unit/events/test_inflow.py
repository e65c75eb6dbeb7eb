"""Ice that enters: in its place in the stream, by numbers of its own, and as if it had been there from the start."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely

from dilatedem.case.load import load
from dilatedem.errors import CaseError, Interrupted
from dilatedem.events.clear import is_clear
from dilatedem.events.inflow import Inflow
from dilatedem.processes.interruption import Interruption
from dilatedem.results.load import load as results
from dilatedem.run import loop
from dilatedem.run.simulation import Simulation
from dilatedem.state.bodies import Bodies

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
#: body 0 is held fast amid the ice
ENTERING = [
    "domain.x_boundary=inflow", "water.velocity=[1.5,0.2]", "field.concentration=0.7", "structure.pile.radius=0.5",
    "time.step_fraction=0.3", "time.duration=7", "body=[{outline=[[-1.5,2.5],[-0.5,2.5],[-0.5,3.5],[-1.5,3.5]], fixed=true}]",
    "output.track=[0,3,60]", "output.hits_in_full=3", "output.hit_threshold=500.0",
]  # fmt: skip
#: the same ice, made otherwise
RECIPES = {
    "square": ["field.shape=square", "ice.thickness_spread=0.2"],
    "hexagon": ["field.shape=hexagon"],
    "lloyd": ["field.regularity=4", "ice.thickness_spread=0.1"],
    "power law": ["field={concentration=0.7,seed=4,size_distribution={kind='power_law',min=1.5,max=4.0}}"],
    "lognormal": ["field.size_distribution={kind='lognormal',spread=0.3}", "ice.thickness_spread=0.2"],
}
FREE = ["structure=[]", "body=[]", "output.track=[]"]


def simulation(*more: str) -> Simulation:
    return Simulation.of_case(load(CROWDED, [*ENTERING, *more]))


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> Path:
    return loop.run(load(CROWDED, ENTERING), tmp_path_factory.mktemp("inflow") / "run", quiet=True)


def test_a_run_that_is_resumed_after_floes_have_come_equals_one_that_never_stopped(run, monkeypatch, tmp_path):
    case, out = load(CROWDED, ENTERING), tmp_path / "run"
    happen, came = Simulation.let_happen, []

    def noted(self):
        came.append(happen(self))
        return came[-1]

    class AskedOnceTheyHaveCome(Interruption):
        asked = property(lambda self: any(came), lambda self, value: None)

    monkeypatch.setattr(Simulation, "let_happen", noted)
    for stops in range(2):
        monkeypatch.setattr(loop, "Interruption", AskedOnceTheyHaveCome)
        came.clear()
        with pytest.raises(Interrupted):
            loop.run(case, out, resume=bool(stops), quiet=True)
    monkeypatch.undo()
    stopped = results(out).summary
    assert 1.0 <= stopped["simulated_s"] < 6.0 and stopped["inflow"]["entered"] > 0
    loop.run(case, out, threads=2, resume=True, quiet=True)  # the number of threads changes nothing
    for name in ("forces.csv", "hits.csv", "energy.csv", "bodies.csv", "ice.pvd"):
        assert (out / name).read_bytes() == (run / name).read_bytes(), name
    for one in sorted((run / "snapshots").iterdir()):
        assert one.read_bytes() == (out / "snapshots" / one.name).read_bytes(), one.name
    told = [json.loads((folder / "summary.json").read_text())["inflow"] for folder in (run, out)]
    assert told[0] == told[1] and told[0]["entered"] > 10


@pytest.mark.parametrize("recipe", [[], *RECIPES.values()], ids=["random", *RECIPES])
def test_undisturbed_ice_is_where_the_stream_has_it_without_a_seam(recipe):
    """Every floe, those of the start and those that came, lies where its strip has drifted to."""
    here = simulation(*FREE, "water.velocity=[-1.5,0.2]", *recipe)
    here.run(6.0)
    assert here.state.inflow.entered[0] > 10 and here.state.inflow.left[0] > 0
    places = dict(enumerate(here.scene.position[:, :2]))
    for number in range(here.entering.first, int(here.state.inflow.strip[0])):
        strip = here.entering.strip(number)
        places |= dict(zip(strip.ids.tolist(), strip.scene.position[:, :2], strict=True))
    expected = np.array([places[number] for number in here.state.ids.body]) + np.array([-1.5, 0.2]) * here.time
    away = here.floes.position[:, :2] - expected
    away[:, 1] -= 15.0 * np.round(away[:, 1] / 15.0)
    np.testing.assert_allclose(away, 0.0, atol=1e-9)
    assert here.contacts == 0 and len(np.unique(here.state.ids.body)) == here.model.floating
    stored = sum(here.energy[name] for name in ("kinetic", "gravity", "buoyancy"))
    begun = simulation(*FREE, "water.velocity=[-1.5,0.2]", *recipe)
    begun.evaluate()
    before = sum(begun.energy[name] for name in ("kinetic", "gravity", "buoyancy"))
    came, went = here.energy["carried_in"], here.energy["carried_out"]
    assert stored + went - came == pytest.approx(before, abs=1e-9 * came) and came > 0.2 * before


@pytest.mark.parametrize("recipe", RECIPES.values(), ids=RECIPES)
def test_ice_of_any_recipe_that_comes_after_a_stop_is_the_same(recipe, tmp_path):
    """Stopped, and gone on with by two threads, once strips of it have come."""
    short = ["time.duration=3.0", "time.step_fraction=0.5", *recipe]
    whole = loop.run(load(CROWDED, [*ENTERING, *FREE, *short]), tmp_path / "whole", quiet=True)
    begun = load(CROWDED, [*ENTERING, *FREE, *short, "time.duration=2.0"])
    loop.run(begun, tmp_path / "parts", quiet=True)
    loop.run(load(CROWDED, [*ENTERING, *FREE, *short]), tmp_path / "parts", threads=2, resume=True, quiet=True)
    for name in ("forces.csv", "energy.csv", "ice.pvd"):
        assert (whole / name).read_bytes() == (tmp_path / "parts" / name).read_bytes(), name
    told = [json.loads((folder / "summary.json").read_text())["inflow"] for folder in (whole, tmp_path / "parts")]
    assert told[0] == told[1] and told[0]["entered"] > 5


def test_ice_that_comes_covers_as_much_as_that_of_the_start():
    here = simulation(*FREE, "water.velocity=[3.0,0.0]", "time.step_fraction=0.5", "domain.size=[30,15]", "field.floe_count=60")
    shares = []
    for k in range(1, 7):
        here.run(2.0 * k)
        ice = np.array([shapely.Polygon(outline) for outline in here.floes.outline])
        ice = np.concatenate([shapely.transform(ice, lambda xy, by=y: xy + [0.0, by]) for y in (-15.0, 0.0, 15.0)])
        band = shapely.box(-15.0, -7.5, 5.0, 7.5)
        shares.append(shapely.area(shapely.intersection(ice, band)).sum() / band.area)
    assert np.abs(np.array(shares) - 0.7).max() < 0.03 and abs(np.mean(shares) - 0.7) < 0.012


def test_a_body_has_one_number_and_one_mass_all_the_way(run):
    told = results(run)
    summary, floes = told.summary["inflow"], told.floes
    start, end = told.snapshot(0.0), told.snapshot(7.0)
    came = np.setdiff1d(end.body, start.body)
    assert len(came) and came.min() > start.body.max()
    assert len(end.body) == len(start.body) + summary["entered"] - summary["left"] == told.summary["floes"]
    named = {int(number) for hit in told.hits_in_full for number in hit.floe}
    assert named and set(end.body) <= set(floes.index) and named <= set(floes.index)
    seen = {}
    for time in told.snapshot_times:
        snapshot = told.snapshot(time)
        for number, outline in zip(snapshot.body.tolist(), snapshot.outlines, strict=True):
            seen.setdefault(number, []).append(shapely.Polygon(outline).area)
    # as a rule: one that stands aslant for a while covers more in plan
    known = [number for number in floes.index if number > 0 and len(seen.get(number, [])) > 2]
    assert len(known) > 40
    for number, row in floes.loc[known].iterrows():
        assert row["plan_area_m2"] == pytest.approx(np.median(seen[number]), abs=0.02)


def test_the_ledger_closes_with_what_came_and_went(run):
    energy = results(run).energy
    assert energy["carried_in"].iloc[-1] > 1e3 and energy["carried_out"].iloc[-1] > 1e3
    turned_over = energy["loss_damping"].iloc[-1] + energy["loss_friction"].iloc[-1]
    assert np.abs(energy["residual"]).max() < 1e-3 * turned_over


def test_the_report_of_such_a_run_is_made(run):
    from dilatedem.post import post

    assert any(path.name == "report.html" for path in post([run]))
    text = (run / "report.html").read_text()
    assert "where ice enters and leaves" in text and "floes that entered" in text


JAM = [*FREE, "structure=[{kind='plane',name='dam',point=[4.0,0.0,0.0],normal=[-1.0,0.0,0.0]}]", "water.velocity=[1.5,0.0]"]


def test_ice_waits_where_a_jam_has_reached_the_side_and_is_never_forced_in():
    here = simulation(*JAM, "domain.size=[9,9]", "field.floe_count=12", "structure.dam.point=[1.0,0,0]")
    waited = entered = 0.0
    while here.state.inflow.waited[0] < 3.0:
        entered = int(here.state.inflow.entered[0])
        here.run(here.time + 1.0)
        assert here.time < 40.0
        if here.state.inflow.entered[0] > entered and here.state.inflow.waited[0] == waited:
            pairs = here.state.pairs
            new = here.state.ids.body[pairs.a[: pairs.count[0]]] >= 0
            assert pairs.overlap[: pairs.count[0]][new].max(initial=0.0) < 0.02
        waited = float(here.state.inflow.waited[0])
    (event,) = here.events
    assert here.state.inflow.since[0] <= here.time and here.state.inflow.lag[0] == pytest.approx(1.5 * waited)
    assert "ice was backed up to where new ice enters, first at t = " in event.remark(here)
    assert event.summary(here)["inflow"]["ice_m"] == pytest.approx(1.5 * (here.time - waited))
    assert simulation(*FREE).events[0].remark(simulation(*FREE)) == ""


def test_floes_that_the_step_is_too_long_for_do_not_enter_and_leave_their_numbers_free():
    here = simulation(*FREE)
    (event,) = here.events
    event._share = 0.22  # of 0.3: only large floes
    here.run(4.0)
    inflow = here.state.inflow
    ids = here.state.ids.body[here.state.ids.body >= here.scene.count]
    assert inflow.omitted[0] > 0 and len(ids) == inflow.entered[0] > 0
    there = sum(len(here.entering.strip(k).ids) for k in range(here.entering.first, int(inflow.strip[0])))
    assert there == inflow.entered[0] + inflow.omitted[0] and ids.max() >= here.scene.count + len(ids)


def test_no_floe_enters_in_a_structure():
    pile = "structure=[{kind='pile',center=[-12.0,0.0],radius=1.0}]"
    here = simulation("body=[]", "output.track=[]", pile, "output.hits_in_full=0")
    here.run(4.0)
    assert here.state.inflow.omitted[0] > 0 and here.state.inflow.entered[0] > 0
    moving = "structure=[{kind='pile',center=[-12.0,0.0],radius=1.0,support={kind='driven',velocity=[0.0,0.0]}}]"
    here = simulation("body=[]", "output.track=[]", moving, "output.hits_in_full=0")
    here.run(4.0)
    assert here.state.inflow.waited[0] > 0 and here.state.inflow.entered[0] == 0


def test_what_stands_in_the_way_is_seen_across_a_periodic_side():
    here = simulation(*FREE)
    strip = here.entering.strip(here.entering.first)
    assert is_clear(here, strip.model, strip.bodies)
    floe = here.state.bodies.position[0, :2].copy()
    for period in (-15.0, 0.0, 15.0):
        position = strip.bodies.position.copy()
        position[0, :2] = floe + [0.0, period]
        assert not is_clear(here, strip.model, Bodies(**{**strip.bodies._asdict(), "position": position}))


@pytest.mark.parametrize(("changes", "sentence"), [
    (["water.velocity=[0,0.2]"], 'domain.x_boundary = "inflow": needs ice that drifts along x, so that one side is upstream; '),
    (["ice.initial_velocity=[0,0,0]"], "ice.initial_velocity has 0 there"),
    (["water.enabled=false"], "needs ice that drifts along x"),
    (["domain.y_boundary=wall"], "the ice drifts along y, too, by 0.2 m/s (water.velocity), out of the lane that it enters in; "
                                 'take domain.y_boundary = "periodic", or turn the scene'),
    (["domain.y_boundary=inflow"], 'domain.y_boundary = "inflow": ice can enter along one axis only'),
    (["field.source=bodies"], 'field.source must be "voronoi"'),
    (["time.error_check=true"], 'time.error_check = true: must be false where a boundary is "inflow"'),
])  # fmt: skip
def test_cases_in_which_no_ice_can_enter_are_refused(changes, sentence):
    with pytest.raises(CaseError) as fault:
        load(CROWDED, [*ENTERING, *changes])
    assert sentence in str(fault.value)


def test_ice_enters_along_y_and_between_walls():
    here = simulation(*FREE, "domain.y_boundary=inflow", "domain.x_boundary=wall", "water.velocity=[0.0,-2.0]")
    here.run(5.0)
    assert here.state.inflow.entered[0] > 5 and here.state.inflow.left[0] > 0 and here.contacts == 0
    outlines = np.concatenate(here.floes.outline)
    assert np.abs(outlines[:, 0]).max() < 7.5
    assert isinstance(here.events[0], Inflow) and len(here.events) == 1
