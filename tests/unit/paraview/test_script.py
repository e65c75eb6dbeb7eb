"""`dilatedem paraview`: a script that stands by itself; where ParaView is installed, the picture that it makes."""

import ast
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from dilatedem.cli import app
from dilatedem.paraview import script
from validation.paraview.picture import colours_of, pvbatch

#: whether ParaView can be run without a window
THERE = bool(shutil.which("pvbatch") and shutil.which("xvfb-run"))


def invoke(*arguments):
    return CliRunner().invoke(app, ["paraview", *map(str, arguments)])


@pytest.fixture
def run(make_run, tmp_path) -> Path:
    folder = make_run(tmp_path / "run", duration=2.0)
    (folder / "structures.vtu").write_text("stands for the structures")
    return folder


def figures(path: Path) -> dict:
    """RUN, CONTACTS and MOVIE as they stand at the top of a script, without running it."""
    found = {}
    for node in ast.parse(path.read_text()).body:
        target = ast.unparse(node.targets[0]) if isinstance(node, ast.Assign) else ""
        if target in ("RUN", "(CONTACTS, MOVIE)"):
            found[target] = ast.literal_eval(node.value)
    return found["RUN"] | {"options": found["(CONTACTS, MOVIE)"]}


def test_the_script_has_the_figures_of_the_run_and_all_of_the_scene(run):
    done = invoke(run)
    assert done.exit_code == 0
    path = run / "view.py"
    assert done.stdout == f"{path}: paraview --script={path} shows the run; pvbatch {path} writes view.png beside it\n"
    assert figures(path) == {
        "title": "Made-up ice against a made-up pile", "size": [20.0, 16.0], "thickness": 0.5,
        "structure_files": ["structures.vtu"], "options": (False, False),
    }  # fmt: skip
    functions = {node.name for node in ast.parse(path.read_text()).body if isinstance(node, ast.FunctionDef)}
    scene = ast.parse(Path(script.__file__).with_name("scene.py").read_text()).body
    assert functions == {node.name for node in scene if isinstance(node, ast.FunctionDef)} and "main" in functions


def test_options_and_structures_that_move(run):
    (run / "structures.pvd").write_text("stands for those that move")
    done = invoke(run, "--movie", "--contacts")
    assert "writes view.png and view.avi beside it" in done.stdout
    found = figures(run / "view.py")
    assert found["options"] == (True, True)
    assert found["structure_files"] == ["structures.vtu", "structures.pvd"]


def test_a_title_cannot_break_the_script(run):
    text = (run / "case.toml").read_text()
    (run / "case.toml").write_text(text.replace("Made-up ice against a made-up pile", "an \\\"end\\\" ''' {size} \\\\"))
    assert invoke(run).exit_code == 0
    assert figures(run / "view.py")["title"] == "an \"end\" ''' {size} \\"


def test_its_own_script_is_replaced_and_no_other(run):
    assert invoke(run).exit_code == 0 and invoke(run, "--movie").exit_code == 0
    (run / "view.py").write_text("# mine")
    done = invoke(run)
    said = f"{run}/view.py: stands in the way: it was not written by dilatedem; move it away\n"
    assert (done.exit_code, done.stderr) == (2, said)
    assert (run / "view.py").read_text() == "# mine"


def test_a_run_without_snapshots(make_run, tmp_path):
    done = invoke(make_run(tmp_path / "bare", duration=2.0, snapshots=False))
    assert done.exit_code == 2 and "has no snapshots to show" in done.stderr
    assert invoke(tmp_path).exit_code == 2


@pytest.mark.skipif(not THERE, reason="needs ParaView; validation/paraview does the same")
def test_paraview_makes_the_picture(crowded, tmp_path):
    """Floes, structures, water and white ground are all there,
    of a real run in real ParaView."""
    run = tmp_path / "run"
    shutil.copytree(crowded, run)
    script.write_script(run, contacts=True)
    done = pvbatch(run / script.SCRIPT, "--picture", tmp_path / "view.png")
    assert done.returncode == 0, done.stderr[-2000:]
    image = np.asarray(Image.open(tmp_path / "view.png").convert("RGB"))
    assert image.shape == (1000, 1600, 3)
    shares = colours_of(image)
    assert shares["ground"] > 0.2 and shares["water"] > 0.02 and shares["floes"] > 0.05 and shares["structures"] > 0.002
