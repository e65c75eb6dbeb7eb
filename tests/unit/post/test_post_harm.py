"""`post` replaces reports and figures of its own, in folders of runs and sweeps, and nothing else."""

import pytest

from dilatedem.errors import CaseError
from dilatedem.post import post


def small(make_run, folder, **more):
    folder = make_run(folder, structures=(), snapshots=False, duration=1.0, **more)
    for name in ("energy.csv", "run.h5"):
        (folder / name).unlink()
    return folder


def files(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def run(make_run, tmp_path):
    return small(make_run, tmp_path / "run")


def refused(folders, beside, sentence):
    before = files(beside)
    with pytest.raises(CaseError, match=sentence):
        post(folders)
    assert files(beside) == before


def test_a_case_that_no_run_wrote_is_no_run(run, tmp_path):
    (run / "case.toml").write_text((run / "case.toml").read_text().partition("\n\n")[2])
    refused([run], tmp_path, "case.toml is not one that a run wrote")


def test_a_report_of_somebody_else_stays(run, tmp_path):
    (run / "report.html").write_text("<html>my own</html>")
    refused([run], tmp_path, "report.html: stands in the way")


def test_a_report_of_its_own_is_replaced(run):
    post([run])
    first = (run / "report.html").read_bytes()
    (run / "report.html").write_bytes(first + b" ")
    post([run])
    assert (run / "report.html").read_bytes() == first


@pytest.mark.parametrize("name", ["report.html", "figures", "summary.json", "summary.json.tmp", "figures/field.png"])
def test_links_are_not_followed(name, run, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "mine").write_text("Run of dilatedem: mine")
    (run / name).parent.mkdir(exist_ok=True)
    (run / name).unlink(missing_ok=True)
    (run / name).symlink_to(elsewhere if name == "figures" else elsewhere / "mine")
    refused([run], tmp_path, "is a link")


@pytest.mark.parametrize("name", ["comparison/report.html", "comparison/figures/mine.svg", "comparison/comparison.csv"])
def test_a_folder_called_comparison_may_be_somebody_elses(name, make_run, run, tmp_path):
    other = small(make_run, tmp_path / "other", seed=2)
    (tmp_path / name).parent.mkdir(parents=True)
    (tmp_path / name).write_text("mine")
    refused([run, other], tmp_path, "stands in the way")
