"""What a run loads before its first step: no more of SciPy than it needs."""

import subprocess
import sys

import pytest
import scipy.spatial

from dilatedem.geometry import qhull

ONLY = "import sys, {modules}; print(*sorted(name for name in sys.modules if name.count('.') == 1 and name.startswith('scipy.')))"


def loaded(modules: str) -> set[str]:
    """Packages of SciPy that a fresh interpreter has after an import."""
    done = subprocess.run([sys.executable, "-c", ONLY.format(modules=modules)], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_a_run_loads_neither_linear_algebra_nor_special_functions():
    unwanted = {f"scipy.{name}" for name in ("linalg", "optimize", "sparse", "spatial", "special", "stats")}
    assert loaded("dilatedem.run.loop").isdisjoint(unwanted)


@pytest.mark.parametrize("order", ["{qhull}; import {scipy}", "{scipy}; import {qhull}"])
def test_the_hull_that_stands_alone_is_that_of_scipy(order):
    # whoever imports SciPy's packages later gets them whole, and one that was loaded before is taken as it is
    imports = order.format(qhull="dilatedem.geometry.qhull", scipy="scipy.spatial, scipy.linalg, scipy.interpolate, scipy.optimize")
    told = (
        f"import {imports}; import dilatedem.geometry.qhull as own, scipy; from scipy.linalg import cython_lapack; "
        "from scipy.spatial import _qhull, cKDTree, distance; import numpy as np; points = np.random.rand(20, 2); "
        "print(own.Voronoi is scipy.spatial.Voronoi, own.QhullError is scipy.spatial.QhullError, "
        "len(scipy.spatial.ConvexHull(points).vertices) > 2, scipy.linalg.inv(2.0 * np.eye(2))[0, 0], "
        "float(scipy.interpolate.LinearNDInterpolator([[0, 0], [1, 0], [0, 1]], [0.0, 1.0, 2.0])(0.25, 0.25)))"
    )
    done = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "True", "True", "0.5", "0.75"]


def test_a_scipy_that_is_built_otherwise_is_loaded_whole(monkeypatch):
    def missing():
        raise ImportError("no module named scipy.spatial._qhull")

    monkeypatch.setattr(qhull, "_alone", missing)
    monkeypatch.setattr(qhull, "STOOD_IN", ("a package that is not loaded",))
    assert qhull._qhull() is scipy.spatial
