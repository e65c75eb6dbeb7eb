"""How the laboratory's figures look: the style of `dilatedem.post`, a colour and a line for each contact model."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from dilatedem.post.figures.canvas import BLUE, PNG_DPI, VERMILION
from dilatedem.state.modes import MODE_NAMES

COLOUR = {"liu2015": VERMILION, "consistent": BLUE}
REFERENCE = {"color": "#4d4d4d", "linewidth": 0.9, "linestyle": (0, (4, 2))}
#: corner contacts greenish, edges in blues and violets, faces in warm colours; no contact light grey
MODE_COLOUR = ("#b7e4c7", "#52b788", "#1b7a4b", "#9ecae1", "#3182bd", "#f6c667", "#e2711d")
APART_COLOUR = "#eceff1"


def save_png(figure: Figure, folder: Path, name: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    options = {"bbox_inches": "tight", "pad_inches": 0.06, "metadata": {"Software": None}}
    figure.savefig(folder / f"{name}.png", dpi=PNG_DPI, **options)


def mode_strip(axes: Axes, edges: np.ndarray, modes: np.ndarray) -> None:
    """Contact mode (n,) as a coloured band between the abscissae edges (n + 1,)."""
    colours = ListedColormap([APART_COLOUR, *MODE_COLOUR])
    axes.pcolormesh(edges, [0.0, 1.0], modes[None, :], cmap=colours, norm=BoundaryNorm(np.arange(-1.5, 7.0), 8), rasterized=True)
    axes.set_yticks([])
    axes.tick_params(bottom=False, labelbottom=False, which="both")
    for spine in axes.spines.values():
        spine.set_visible(False)


def mode_handles(seen: set[int]) -> list[Patch]:
    """Legend entries of the modes that occur."""
    named = [Patch(color=MODE_COLOUR[m], label=MODE_NAMES[m]) for m in sorted(seen) if m >= 0]
    return named + ([Patch(color=APART_COLOUR, label="apart")] if -1 in seen else [])
