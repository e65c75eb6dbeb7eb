"""Load events from the state of a run to run.h5 and on into figures and the report."""

from dataclasses import replace

import numpy as np
import pytest

from dilatedem.output.archive import ContactStatistics, FloeTable, PlanOutline, RunArchive
from dilatedem.output.kept_hits import kept_hits
from dilatedem.post.figures.hits import hit_figure
from dilatedem.post.folders import hits_on, run_statistics
from dilatedem.post.read import open_run
from dilatedem.post.report.events import event_rows, pressure_words
from dilatedem.results.archive import read_archive
from dilatedem.state import hits
from dilatedem.state.hits import no_hits

DT = 1e-3  # s
TURN = 0.5  # rad
#: structure, step of the peak and peak [N] of the events that are kept, in no order
EVENTS = ((0, 400, 5e3), (1, 900, 9e3))


def state() -> hits.Hits:
    """Two structures, three places of which two are taken: two floes pushed, one behind the other."""
    found = no_hits(2, 3, 100)
    for place, (structure, step, peak) in enumerate(EVENTS, start=2):
        found.counts[place, [hits.STRUCTURE, hits.START, hits.LAST, hits.PEAK_STEP]] = structure, step - 10, step + 20, step
        found.counts[place, [hits.FIRST, hits.SAMPLES, hits.FLOES, hits.CONTACTS, hits.BODIES]] = step - 40, 80, 2, 2, 2
        found.counts[place, [hits.BODY, hits.MODE]] = 3, 5
        found.figures[place, [hits.PEAK, hits.AREA, hits.PRESSURE]] = peak, 2e-3, peak / 2e-3
        found.history[place, :80, 0] = peak * np.exp(-(((np.arange(80) - 40) / 8.0) ** 2))
        found.floe[place, :2] = 3, 7
        found.pose[place, :2, :3] = [[1.5, 0.2, 0.0], [-0.5, 0.2, 0.0]]
        found.pose[place, :2, 3:] = [np.cos(0.5 * TURN), 0.0, 0.0, np.sin(0.5 * TURN)]
        found.touch[place, :2] = [[3, -1 - structure, 5], [3, 7, 6]]
        found.arrow[place, :2] = [[2.5, 0.2, 0.0, peak, 0.0, 0.0], [0.5, 0.2, 0.0, -0.5 * peak, 0.0, 0.0]]
    return found


@pytest.fixture
def archive(tmp_path):
    orientation = np.tile([1.0, 0.0, 0.0, 0.0], (9, 1))
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    start = np.arange(9.0)
    floes = FloeTable(np.arange(9), start, 0 * start, np.full(9, 4.0), np.ones(9), np.ones(9), np.full(9, 8),
                      np.arange(9), [square + [x, 0.0] for x in start])  # fmt: skip
    nothing = {partners: ContactStatistics(*np.zeros((4, 7))) for partners in ("ice_ice", "ice_structure")}
    outlines = [PlanOutline(name, "pile", square + [3.5, 0.0], True, np.array([3.5, 0.0])) for name in ("one", "two")]
    kept = kept_hits(state(), DT, orientation)
    written = RunArchive([], nothing, floes, outlines=outlines, hits=kept_hits(no_hits(2, 3, 100), DT, orientation), dt=DT)
    written.update([], nothing, kept)
    written.write(tmp_path / "run.h5")
    written.close()
    return read_archive(tmp_path / "run.h5")


def test_events_come_back_the_highest_first(archive):
    assert [hit.structure for hit in archive.hits] == ["two", "one"]
    highest = archive.hits[0]
    assert (highest.figures["peak_N"], highest.figures["peak_time_s"], highest.mode) == (9e3, 0.9, "edge-face")
    assert highest.time[np.argmax(highest.force[:, 0])] == pytest.approx(0.9) and len(highest.time) == 80
    assert highest.floe.tolist() == [3, 7] and highest.contact_body.tolist() == [[3, -2], [3, 7]]
    np.testing.assert_allclose(highest.turned, TURN)


def test_a_figure_shows_the_force_and_who_pushed_whom(archive, make_run, tmp_path):
    run = open_run(make_run(tmp_path / "run", snapshots=False, duration=2.0))
    run = replace(run, floes=archive.floes, outlines=archive.outlines)
    drawing = hit_figure(run, archive.hits[0], 1)
    assert drawing.name == "hit_01" and "2 floes pushed, led by floe 3" in drawing.caption and "4.5 MPa" in drawing.caption
    history, plan = drawing.figure.axes
    line = next(line for line in history.lines if line.get_label() == "every step")
    assert line.get_xdata()[np.argmax(line.get_ydata())] == pytest.approx(0.0, abs=1e-9) and max(line.get_ydata()) == 9.0
    arrows = [text for text in plan.texts if text.arrow_patch is not None]
    assert [arrow.xy for arrow in arrows] == [pytest.approx((2.5, 0.2)), pytest.approx((0.5, 0.2))]
    ways = [np.subtract(arrow.xy, arrow.xyann) for arrow in arrows]
    assert all(way[0] > 0.0 for way in ways) and ways[0][0] == pytest.approx(2.0 * ways[1][0]), "towards the structure"


def test_tables_and_shares_are_those_of_hits_csv(make_run, tmp_path):
    folder = make_run(tmp_path / "run", snapshots=False, duration=2.0)
    columns = "structure,start_s,rise_s,duration_s,peak_N,peak_time_s,impulse_Ns,body,mode,area_m2,pressure_Pa,crushed_m,bodies\n"
    rows = [
        "pile,0.1,0.02,0.05,8000,0.12,90,4,edge-face,0.004,1.5e6,0,1\n",
        "pile,1.5,0.01,0.03,30000,1.51,200,9,face-face,0.005,6e6,0,3\n",
    ]
    (folder / "hits.csv").write_text(columns + "".join(rows))
    told = {"threshold_N": 2500.0, "gap_s": 0.7, "meaning": "so much", "structures": {}}
    run = open_run(folder)
    run = replace(run, summary=run.summary | {"hits": told})
    found = hits_on(run, "pile")
    assert (found["count"], found["threshold_N"], found["gap_s"]) == (2, 2500.0, 0.7)
    assert (found["share_above_1_MPa"], found["share_above_2_MPa"], found["share_above_5_MPa"]) == (1.0, 0.5, 0.5)
    assert [row[:3] for row in event_rows(run, "pile")] == [["1.51", "30", "10"], ["0.12", "8", "20"]]
    words = pressure_words(run, "pile", run_statistics(run)["loads"]["pile"])
    assert words == "Of the 2 load events 100 % above 1 MPa, 50 % above 2 MPa, 50 % above 5 MPa: so much."
