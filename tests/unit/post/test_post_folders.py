"""What `post` and `info` make of whole folders."""

import json
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.post import info, post
from dilatedem.post.read import open_run

PLANE = {"kind": "plane", "name": "quay", "point": [9.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}


def test_whole_run(make_run, tmp_path):
    folder = make_run(tmp_path / "run")
    before = json.loads((folder / "summary.json").read_text())
    written = post([folder])
    assert all(path.is_file() for path in written)
    names = {path.name for path in written}
    figures = (
        "field",
        "plan",
        "speed",
        "force_pile",
        "peak_pile",
        "load_around_pile",
        "load_map_pile",
        "energy",
    )
    assert {f"{name}.{kind}" for name in figures for kind in ("png", "svg")} <= names
    after = json.loads((folder / "summary.json").read_text())
    found = after.pop("post")
    assert after == before
    assert list(after) == list(before)
    hits = found["loads"]["pile"]["hits"]
    assert hits["count"] > 0 and hits["threshold_N"] == pytest.approx(np.mean(open_run(folder).floes.mass))
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.count("separate hits: horizontal force of at least") == 2  # in the table and under the figure of the force
    assert "centre of the load, 0° = upstream; counter-clockwise seen from above" in page
    assert found["loads"]["pile"]["around"]["share_within_90_deg_of_upstream"] == pytest.approx(1.0)
    check_page(folder / "report.html", pictures=len(figures))
    text = info(folder)
    assert "completed, 10 s of 10 s" in text
    assert "peak" in text


def check_page(path, *, pictures):
    """One file without references to others: what it shows, it holds."""
    page = path.read_text(encoding="utf-8")
    assert page.count("<svg") == pictures == page.count("<figcaption>")
    assert re.findall(r"(?:src|href)=[\"'](?!#|data:)[^\"']*", page) == []
    assert "@import" not in page and "None" not in page and "nan" not in page.split()
    assert not re.search(r"fetch\(|XMLHttpRequest|https?://(?!www\.w3\.org/)", page)
    ids = re.findall(r"<clipPath id=\"([^\"]+)\"", page)
    assert len(ids) == len(set(ids))


def test_killed_run_of_two_structures(make_run, tmp_path):
    pile = {"kind": "pile", "name": "<pile & co>", "center": [4.0, 0.0], "radius": 1.5}
    folder = make_run(tmp_path / "run", structures=(pile, PLANE), duration=1.0, status="running", snapshots=False)
    for name in ("forces.csv", "energy.csv"):
        text = (folder / name).read_text()
        (folder / name).write_text(text[: len(text) // 2])
    (folder / "run.h5").unlink()
    post([folder])
    page = (folder / "report.html").read_text()
    assert "did not reach its end" in page
    assert "&lt;pile &amp; co&gt;" in page
    assert "running, 1 s of 1 s" in info(folder)


def test_case_without_anything_else(make_run, tmp_path):
    folder = make_run(tmp_path / "run", structures=(), snapshots=False)
    for name in ("forces.csv", "energy.csv", "run.h5", "summary.json"):
        (folder / name).unlink()
    assert {path.name for path in post([folder])} == {"summary.json", "report.html"}
    assert "none recorded" in info(folder)


def test_unreadable_summary_is_left_alone(make_run, tmp_path):
    folder = make_run(tmp_path / "run", structures=(), snapshots=False)
    for name in ("forces.csv", "energy.csv", "run.h5"):
        (folder / name).unlink()
    (folder / "summary.json").write_text("{ cut sho")
    assert {path.name for path in post([folder])} == {"report.html"}
    assert (folder / "summary.json").read_text() == "{ cut sho"


def test_runs_of_a_shell_loop_are_compared(make_run, tmp_path):
    for index, (speed, seed) in enumerate([(0.2, 1), (0.2, 2), (0.4, 1)]):
        folder = make_run(
            tmp_path / f"v{speed}_{seed}", current=(speed, 0.0), seed=seed, duration=1.0, scale=index + 1.0,
            snapshots=False,
        )  # fmt: skip
        for name in ("energy.csv", "run.h5"):
            (folder / name).unlink()
    runs = sorted(tmp_path.iterdir())
    written = post(runs)
    beside = tmp_path / "comparison"
    assert {beside / "comparison.csv", beside / "report.html"} <= set(written)
    header, *rows = (beside / "comparison.csv").read_text().splitlines()
    assert header.startswith("water.velocity,seed,run,status,pile_fx_max_N")
    assert len(rows) == 3
    assert (beside / "figures/force_by_water_velocity_pile.png").is_file()
    page = (beside / "report.html").read_text()
    assert 'href="../v0.2_1/report.html"' in page
    # The folder of the comparison itself is passed over when a shell's wildcard names it too.
    shutil.rmtree(runs[2])
    assert beside / "report.html" in post([*runs[:2], beside])


@pytest.mark.parametrize(("share", "cell", "shown"), [(None, "", "–"), (0.0, "0.0", "0")])
def test_a_comparison_tells_no_residual_from_none(share, cell, shown, make_run, tmp_path):
    for seed in (1, 2):
        folder = make_run(tmp_path / f"seed{seed}", seed=seed, duration=1.0, snapshots=False)
        summary = json.loads((folder / "summary.json").read_text())
        summary["energy"]["residual_over_work"] = share
        (folder / "summary.json").write_text(json.dumps(summary))
        for name in ("energy.csv", "run.h5", "forces.csv"):
            (folder / name).unlink()
    post(sorted(tmp_path.iterdir()))
    rows = (tmp_path / "comparison/comparison.csv").read_text().splitlines()
    assert [row.split(",")[-2] for row in rows] == ["residual_over_work", cell, cell]
    assert (tmp_path / "comparison/report.html").read_text().count(f"<td>{shown}</td></tr>") == 2


def test_folder_that_is_neither_is_refused_before_anything_is_written(make_run, tmp_path):
    folder = make_run(tmp_path / "run", structures=(), snapshots=False)
    (tmp_path / "empty").mkdir()
    with pytest.raises(CaseError, match="neither a run"):
        post([folder, tmp_path / "empty"])
    assert not (folder / "report.html").exists()
    with pytest.raises(CaseError, match="no run to be found"):
        info(tmp_path / "empty")


def test_info_needs_neither_matplotlib_nor_the_simulation(make_run, tmp_path):
    folder = make_run(tmp_path / "run", snapshots=False)
    code = (
        "import sys, pathlib; from dilatedem.post import info; info(pathlib.Path(sys.argv[1]));"
        "print([name for name in ('matplotlib', 'meshio', 'numba', 'jinja2') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code, str(folder)], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
