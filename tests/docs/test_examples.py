"""The Python of the pages runs as it is printed, block after block, in a folder with the runs that they name."""

import re
from pathlib import Path

import pytest

from dilatedem.sweeps.sweep import sweep

ROOT = Path(__file__).parents[2]
CASE = ROOT / "tests" / "cases" / "crowded.toml"


@pytest.fixture(scope="module")
def runs(crowded, tmp_path_factory) -> Path:
    """A folder with runs/pile and runs/pile-sweep."""
    folder = tmp_path_factory.mktemp("docs")
    (folder / "runs").mkdir()
    (folder / "runs/pile").symlink_to(crowded, target_is_directory=True)
    short = ["time.duration=0.5", "output.track=[]"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(ROOT))  # the package of this tree, whatever is installed
        sweep(CASE, vary=["water.velocity=[0.8,0.15],[1,0]"], seeds=2, jobs=1, out=folder / "runs/pile-sweep", overrides=short)
    return folder


@pytest.mark.parametrize("page", ["README.md", "docs/output.md", "docs/python.md"])
def test_python_of_a_page_runs(page, runs, monkeypatch, capsys):
    matplotlib = pytest.importorskip("matplotlib")
    monkeypatch.chdir(runs)
    text = (ROOT / page).read_text(encoding="utf-8")
    names: dict = {}
    with matplotlib.rc_context({"backend": "agg"}):
        for found in re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
            line = text.count("\n", 0, found.start(1))
            exec(compile("\n" * line + found[1], page, "exec"), names)
        names["plt"].close("all") if "plt" in names else None
    assert names and capsys.readouterr().out, "no Python on this page"
    if page == "docs/python.md":
        assert {"force.png", "load_map.png", "snapshot.png"} <= {path.name for path in runs.iterdir()}
        assert names["sweep"].table["water.velocity.0"].tolist() == [0.8, 0.8, 1.0, 1.0]
        assert names["sweep"].table["water.velocity.1"].tolist() == [0.15, 0.15, 0.0, 0.0]
        assert names["load"].sizes["angle"] == 72
