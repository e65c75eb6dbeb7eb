"""A run replaces and removes what runs wrote, and nothing else."""

import os
from pathlib import Path

import pytest

from dilatedem.errors import CaseError
from dilatedem.files.lock import Lock
from dilatedem.output import folder

HEADER = "# dilatedem 0.2.0, seed 1\n\ntitle = \"x\"\n"


def made(out: Path, *, case: str = HEADER, names=("summary.json", "restart.h5", "forces.csv")) -> Path:
    out.mkdir()
    (out / "case.toml").write_text(case)
    for name in names:
        (out / name).write_text(name)
    return out


def contents(out: Path) -> dict:
    return {path: path.read_bytes() if path.is_file() else None for path in out.rglob("*")}


@pytest.mark.parametrize("name", [name for name in folder.FILES] + ["energy.csv.tmp", "figures/mine.svg", "snapshots/mine.txt"])
@pytest.mark.parametrize("overwrite", [False, True])
def test_a_file_that_no_run_wrote_stands_in_the_way(name, overwrite, tmp_path):
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    before = contents(tmp_path)
    with pytest.raises(CaseError, match="stands in the way: .* holds no run"):
        folder.check(tmp_path, overwrite=overwrite)
    assert contents(tmp_path) == before


def test_other_files_and_empty_folders_do_not(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "snapshots").mkdir()
    folder.check(tmp_path)
    folder.check(tmp_path / "none")


def test_a_case_of_somebody_beside_files_of_a_run_is_his(tmp_path):
    out = made(tmp_path / "out", case="[field]\nfloe_count = 3\n")
    with pytest.raises(CaseError, match=r"out/\S+: stands in the way"):
        folder.check(out, overwrite=True)


def test_a_case_copied_from_a_run_makes_no_run(tmp_path):
    out = made(tmp_path / "out", names=())
    with pytest.raises(CaseError, match=r"case.toml: stands in the way"):
        folder.check(out, overwrite=True)
    with Lock(out):  # as of a command that is refused in the end
        with pytest.raises(CaseError, match=r"case.toml: stands in the way"):
            folder.check(out, overwrite=True)
    with Lock(out) as lock:
        lock.keep()
    folder.check(out, overwrite=True)  # killed after its first file


def test_a_run_is_replaced_when_told_to_and_what_is_not_its_own_stays(tmp_path):
    out = made(tmp_path / "out")
    with pytest.raises(CaseError, match="holds a run already"):
        folder.check(out)
    own = ["snapshots/ice_000000.vtu", "snapshots/ice_1000000.vtu", "snapshots/ice_000003.vtu.tmp", "figures/force_pile.svg"]
    own += ["figures/load_map_pile.png", "report.html", "stopped.h5", "restart.h5.tmp", "energy.csv", "figures/field.pdf"]
    foreign = ["snapshots/film.mp4", "snapshots/ice_000000.vtu.bak", "figures/mine.svg", "figures/field.eps", "notes.txt"]
    for name in own + foreign:
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_text(name)
    folder.check(out, overwrite=True)
    folder.clear(out)
    left = {str(path.relative_to(out)) for path in out.rglob("*") if path.is_file()}
    assert left == {"case.toml", *foreign}


@pytest.mark.parametrize("name", ["case.toml", "energy.csv", "restart.h5.tmp", "snapshots", "figures", "snapshots/ice_000000.vtu"])
@pytest.mark.parametrize("resume", [False, True])
def test_links_are_not_followed(name, resume, tmp_path):
    out, elsewhere = made(tmp_path / "out"), tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "ice_000000.vtu").write_text("mine")
    target = elsewhere if name in ("snapshots", "figures") else elsewhere / "ice_000000.vtu"
    (out / name).parent.mkdir(exist_ok=True)
    if name == "case.toml":
        target = elsewhere / "case.toml"
        os.rename(out / name, target)
    (out / name).symlink_to(target)
    with pytest.raises(CaseError, match=r"(is a link|stands in the way)"):
        folder.check(out, overwrite=not resume, resume=resume)
    folder.clear(out)  # were it called all the same
    assert (elsewhere / "ice_000000.vtu").read_text() == "mine"


@pytest.mark.parametrize("name", ["energy.csv", "restart.h5", "snapshots"])
@pytest.mark.parametrize("resume", [False, True])
def test_what_could_not_be_removed_is_told_before_anything_is(name, resume, tmp_path):
    out = made(tmp_path / "out", names=("summary.json",))
    if name == "snapshots":
        (out / name).write_text("mine")
    else:
        (out / name).mkdir()
    with pytest.raises(CaseError, match=f"{name}: stands in the way: it is no "):
        folder.check(out, overwrite=not resume, resume=resume)


def test_whenever_clearing_is_killed_the_folder_may_be_overwritten(tmp_path, monkeypatch):
    out = made(tmp_path / "out", names=folder.FILES[:-1])
    with Lock(out) as lock:
        lock.keep()
    removed = []

    def remove(path, missing_ok=False):
        folder.check(out, overwrite=True)
        removed.append(path)
        if path.exists():
            os.unlink(path)

    monkeypatch.setattr(Path, "unlink", remove)
    folder.clear(out)
    folder.check(out, overwrite=True)
    assert len(removed) > 10
