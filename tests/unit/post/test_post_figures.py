"""Figures: what they hold, that they are true to scale, and that they come out the same every time."""

import hashlib
from dataclasses import replace

import matplotlib
import numpy as np
import pytest

from dilatedem.post.figures import canvas
from dilatedem.post.figures.field import field_figure, plan_figure, speed_figure
from dilatedem.post.figures.loads import force_figure, peak_figure
from dilatedem.post.figures.map import load_around_figure, load_map_figure, seen_from, upstream_place, upstream_side
from dilatedem.post.figures.plan import choose_view, periodic_copies
from dilatedem.post.folders import hits_on, run_drawings
from dilatedem.post.loads import angular_statistics
from dilatedem.post.read import open_run
from dilatedem.post.snapshots import snapshots_at

SLOPE = {"kind": "plane", "name": "slope", "point": [8.0, 0.0, 0.0], "normal": [-1.0, 0.0, 1.0]}
FLOOR = {"kind": "plane", "name": "floor", "point": [0.0, 0.0, -5.0], "normal": [0.0, 0.0, 1.0]}


@pytest.fixture(scope="module")
def run(make_run, tmp_path_factory):
    return open_run(make_run(tmp_path_factory.mktemp("figures") / "run"))


def square(x, y, half=1.0):
    return np.array([[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]])


def test_floes_across_a_periodic_side_are_drawn_on_both(run):
    outlines = [square(0.0, 0.0), square(3.0, 7.8), square(9.8, 0.0)]  # y is periodic at 8, x is open
    drawn, owner = periodic_copies(run, outlines)
    assert owner.tolist() == [0, 1, 2, 1]
    assert np.allclose(drawn[3], square(3.0, 7.8 - 16.0))


def test_floe_in_the_corner_of_two_periodic_axes_has_three_images(run):
    case = run.case | {"domain": run.case["domain"] | {"x_boundary": "periodic"}}
    drawn, owner = periodic_copies(replace(run, case=case), [square(9.5, -7.5)])
    assert owner.tolist() == [0, 0, 0, 0]
    centres = {tuple(np.round(outline.mean(axis=0), 6)) for outline in drawn}
    assert centres == {(9.5, -7.5), (-10.5, -7.5), (9.5, 8.5), (-10.5, 8.5)}


def test_view_follows_floes_through_open_sides_but_not_for_ever(run):
    inside = choose_view(run, [[square(0.0, 0.0)]])
    beyond = choose_view(run, [[square(14.0, 0.0)]])
    far = choose_view(run, [[square(500.0, 0.0)]])
    assert inside.x[1] == pytest.approx(10.0 + 0.4)
    assert beyond.x[1] == pytest.approx(15.0 + 0.4)
    assert far.x[1] == pytest.approx(20.0 + 0.4)


def test_plan_views_are_true_to_scale_and_hold_every_floe(run):
    snapshots = snapshots_at(run, (0.0, 0.5, 1.0))
    drawing = plan_figure(run, snapshots)
    panels = drawing.figure.axes
    assert [axes.get_title("left") for axes in panels] == ["t = 0 s", "t = 5 s", "t = 10 s"]
    for axes in panels:
        assert axes.get_aspect() == 1.0
        assert axes.get_xlabel() + axes.get_ylabel() != ""
        assert len(axes.collections[0].get_paths()) >= len(run.floes.outlines)


def test_plan_views_show_current_and_wind(run):
    windy = replace(run, case=run.case | {"wind": {"velocity": [8.0, 6.0]}})
    calm, blown = ([text.get_text() for text in field_figure(of, of.floes.outlines).figure.axes[0].texts] for of in (run, windy))
    assert "current 0.3 m/s" in calm and not any("wind" in words for words in calm)
    assert "current 0.3 m/s" in blown and "wind 10 m/s" in blown
    assert "the arrows give the current and the wind" in field_figure(windy, run.floes.outlines).caption


def test_speed_map_has_one_scale_for_all_times(run):
    drawing = speed_figure(run, snapshots_at(run, (0.0, 1.0)))
    panels = [axes for axes in drawing.figure.axes if axes.collections and axes.get_title("left")]
    for axes in panels:
        assert axes.collections[0].get_clim() == (0.0, pytest.approx(0.3))
    assert len(panels) == 2
    assert "m/s" in drawing.figure.axes[-1].get_ylabel()


def test_force_history_keeps_the_extremes_when_windows_are_joined(run):
    history = run.forces["pile"]
    long = {name: np.tile(column, 5) for name, column in history.items()}
    long["time_s"] = 0.01 * np.arange(1, len(long["time_s"]) + 1)
    drawing = force_figure("pile", long)
    top = drawing.figure.axes[0].collections[0].get_datalim(drawing.figure.axes[0].transData).y1
    assert top == pytest.approx(history["fx_max_N"].max() / 1e3)
    assert "kN" in drawing.figure.axes[0].get_ylabel()


def test_force_history_says_how_many_hits_there_were_and_what_counts_as_one(run):
    hits = hits_on(run, "pile")
    drawing = force_figure("pile", run.forces["pile"], hits)
    words = f"{hits['count']} separate hits: horizontal force of at least"
    assert drawing.figure.axes[1].get_title("left").startswith(words) and words in drawing.caption
    assert "apart by 1 s or more below it" in drawing.caption
    assert "separate" not in force_figure("pile", run.forces["pile"]).caption


def test_quiet_structure_has_no_peak_to_draw(run):
    still = {name: np.zeros_like(column) for name, column in run.forces["pile"].items()}
    still["time_s"] = run.forces["pile"]["time_s"]
    assert peak_figure("pile", still) is None
    assert force_figure("pile", still) is not None


@pytest.mark.parametrize(("current", "line"), [((0.3, 0.0), "fx_N"), ((0.0, 0.3), "fy_N"), ((0.0, 0.0), "fx_N")])
def test_peak_is_drawn_along_the_current_wherever_it_goes(current, line, run):
    history = run.forces["pile"]
    drawing = peak_figure("pile", history, current, {"threshold_N": 1000.0})
    axes = drawing.figure.axes[0]
    drawn = {drawn.get_label(): drawn.get_ydata() for drawn in axes.lines}
    assert drawn["highest of any step"].max() == pytest.approx(history["fh_max_N"].max() / 1e3)
    means = next(values for label, values in drawn.items() if label.startswith("mean along"))
    window = np.argmax(history["fh_max_N"])
    assert np.min(np.abs(means - history[line][window] / 1e3)) < 1e-12
    assert ("no current" in drawing.caption) == (current == (0.0, 0.0))
    assert drawn["a hit: 1 kN"] == [1.0, 1.0] and axes.get_ylabel() == "Horizontal force (kN)"


def loaded_at(load_map, angle):
    """The map with its whole load in the sector of this angle from +x [deg]."""
    sector = np.searchsorted(load_map.place_edges, angle, side="right") - 1
    return replace(load_map, impulse=load_map.impulse * 0.0 + np.eye(len(load_map.impulse))[sector][:, None] * 9.0)


@pytest.mark.parametrize("upstream", [180.0, -127.5, 92.5, None])
def test_every_angle_counts_from_upstream(upstream, run):
    """A load on the upstream side stands at 0 in both figures and in the statistics, and the axes say so."""
    where = upstream if upstream is not None else 0.0
    load_map = loaded_at(run.load_maps["pile"], (where + 1.0 + 180.0) % 360.0 - 180.0)
    assert angular_statistics(load_map, upstream)["centre_of_load_from_zero_deg"] == pytest.approx(0.0, abs=2.51)
    around = load_around_figure(load_map, upstream).figure
    axes = around.axes[0]
    rays = {label.get_text(): np.degrees(tick) for tick, label in zip(axes.get_xticks(), axes.get_xticklabels(), strict=True)}
    zero = rays["0°"]
    highest = max(axes.patches, key=lambda bar: bar.get_height())
    off = (np.degrees(highest.get_x() + 0.5 * highest.get_width()) - zero + 180.0) % 360.0 - 180.0
    assert abs(off) <= 2.51
    assert (rays["90°"] - zero) % 360.0 == pytest.approx(90.0)  # counter-clockwise
    developed = load_map_figure(load_map, upstream).figure.axes[0]
    edges = developed.collections[0].get_coordinates()[0, :, 0]
    values = developed.collections[0].get_array().filled(0.0).reshape(len(load_map.height_edges) - 1, -1).sum(axis=0)
    column = int(np.argmax(values))
    assert abs(0.5 * (edges[column] + edges[column + 1])) <= 2.51
    word = "0 = upstream" if upstream is not None else "0 = +x (still water)"
    for said in (around.get_supxlabel().replace("°", ""), developed.get_xlabel()):
        assert word in said and "counter-clockwise seen from above" in said


def test_a_load_map_shows_impulse_which_does_not_grow_as_bins_shrink(run):
    load_map = run.load_maps["pile"]
    drawing = load_map_figure(load_map, 180.0, afloat=(0.45, 0.05))
    mesh, bar = drawing.figure.axes[0].collections[0], drawing.figure.axes[1]
    unit = {"Impulse per bin (N s)": 1.0, "Impulse per bin (kN s)": 1e3}[bar.get_ylabel()]
    assert mesh.get_array().filled(0.0).sum() * unit == pytest.approx(load_map.impulse.sum())
    low, high = mesh.get_clim()
    assert high / low == pytest.approx(100.0)
    # one contact, whose force is booked at one point, in bins of half the width
    one = loaded_at(load_map, 179.0)
    halves = np.kron(one.impulse, np.array([[0.0], [1.0]]))
    fine = replace(one, place_edges=np.linspace(-180.0, 180.0, len(halves) + 1), impulse=halves)
    peaks = [load_map_figure(each, 180.0).figure.axes[0].collections[0].get_array().max() for each in (one, fine)]
    bars = [max(bar.get_height() for bar in load_around_figure(each, 180.0).figure.axes[0].patches) for each in (one, fine)]
    assert peaks[0] == peaks[1] and bars[0] == pytest.approx(bars[1])


def test_a_load_map_marks_draft_freeboard_and_upstream(run):
    assert run.afloat == (pytest.approx(0.5 * 915.0 / 1025.0), pytest.approx(0.5 - 0.5 * 915.0 / 1025.0))
    axes = load_map_figure(run.load_maps["pile"], 180.0, afloat=run.afloat).figure.axes[0]
    assert {text.get_text() for text in axes.texts} == {"draft", "freeboard", "upstream"}
    assert [line.get_ydata()[0] for line in axes.lines][:3] == pytest.approx([0.0, -run.afloat[0], run.afloat[1]])
    low, high = axes.get_ylim()
    assert low < -run.afloat[0] and high > run.afloat[1]
    dry = replace(run, case=run.case | {"water": {"enabled": False, "density": 1025.0}})
    assert dry.afloat is None and not list(load_map_figure(run.load_maps["pile"], None).figure.axes[0].texts)


def test_upstream_on_axes_around_an_outline_and_along_a_line(run):
    plain = run.load_maps["pile"]
    corners = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * [4.0, 1.0] + [10.0, 5.0]  # as a box lays them out
    box = replace(plain, place="distance", attributes={"center_m": np.array([10.0, 5.0])})
    places = [upstream_place(box, upstream, corners) for upstream in (90.0, 180.0, -90.0, 0.0)]
    assert places == pytest.approx([4.0, 9.0, 14.0, 19.0])
    assert upstream_place(box, None, corners) is None and upstream_place(box, 90.0, np.zeros((0, 2))) is None
    wall = replace(plain, place="distance", attributes={"axis": np.array([0.0, 1.0, 0.0]), "center_m": np.zeros(3)})
    assert [upstream_side(wall, upstream) for upstream in (180.0, 135.0, -100.0, None)] == [None, 1.0, -1.0, None]
    assert upstream_place(wall, 180.0, corners) is None and upstream_side(box, 90.0) is None


def test_polar_bars_stand_at_their_sectors(run):
    load_map = run.load_maps["pile"]
    figure = load_around_figure(load_map, 180.0).figure
    axes = figure.axes[0]
    heights = np.array([bar.get_height() for bar in axes.patches])
    starts = np.degrees([bar.get_x() for bar in axes.patches])
    assert starts == pytest.approx(load_map.place_edges[:-1])
    assert figure.get_suptitle() == "Mean load on pile per sector of 5° (N)"
    assert np.sum(heights) == pytest.approx(load_map.impulse.sum() / load_map.duration)


def test_sectors_in_the_order_seen_from_upstream():
    edges = np.linspace(-180.0, 180.0, 5)
    turned, values = seen_from(180.0, edges, np.array([1, 2, 3, 4]))
    assert turned.tolist() == [-180.0, -90.0, 0.0, 90.0, 180.0]
    assert values.tolist() == [3, 4, 1, 2]


def test_untouched_structure_has_no_load_map(run):
    load_map = run.load_maps["pile"]
    assert load_map_figure(replace(load_map, impulse=0.0 * load_map.impulse), 180.0) is None


def test_every_structure_gets_its_figures_and_a_plane_no_polar_plot(make_run, tmp_path):
    pile = {"kind": "pile", "name": "pile", "center": [4.0, 0.0], "radius": 1.5}
    folder = make_run(tmp_path / "run", structures=(pile, SLOPE, FLOOR), snapshots=False, current=(0.0, 0.0))
    names = [drawing.name for drawing in run_drawings(open_run(folder))]
    assert names.count("load_around_pile") == 1
    assert {"force_slope", "force_floor", "load_map_slope", "peak_floor"} <= set(names)
    assert not {"load_around_slope", "plan", "speed"} & set(names)


def test_same_bytes_every_time_whatever_the_users_settings(run, tmp_path):
    def digest(folder):
        canvas.save(field_figure(run, run.floes.outlines), folder)
        return [hashlib.sha256((folder / f"field.{kind}").read_bytes()).hexdigest() for kind in ("png", "svg")]

    first = digest(tmp_path / "a")
    with matplotlib.rc_context({"font.size": 20.0, "axes.facecolor": "black", "svg.hashsalt": None}):
        assert digest(tmp_path / "b") == first
    svg = (tmp_path / "a/field.svg").read_text()
    assert "<dc:date>" not in svg
