"""How figures look and how they are written: one style, PNG and SVG, the same bytes every time."""

from __future__ import annotations

import functools
import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from dilatedem.files.atomic import write_bytes

# Okabe & Ito's colours, told apart by colour-blind readers.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
SERIES = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

WATER, ICE, FAST_ICE, ICE_EDGE = "#cfe0ec", "#ffffff", "#c8c2b4", "#42586b"
STRUCTURE, STRUCTURE_EDGE = "#D55E00", "#6b2f00"

PNG_DPI = 160
#: kinds of files that a figure may be written as, and what says nothing in them of when and by what they were made
FORMATS = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}, "pdf": {"CreationDate": None, "Creator": None}}
USUAL_FORMATS = ("png", "svg")

STYLE = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so a figure is the same on every machine
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "grid.color": "#d9dee3",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "lines.markersize": 5.0,
    "hatch.linewidth": 0.6,
    "svg.fonttype": "path",
    "path.simplify": True,
}


@dataclass(frozen=True)
class Drawing:
    """A finished figure: the name of its files, what is shown, and the figure itself."""

    name: str
    title: str
    caption: str
    figure: Figure


def styled(draw: Callable[..., Drawing | None]) -> Callable[..., Drawing | None]:
    """Run a drawing function under the house style, whatever the user's own settings of matplotlib."""

    @functools.wraps(draw)
    def drawn(*args, **kwargs):
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(STYLE)
            return draw(*args, **kwargs)

    return drawn


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of this size [inch] with room kept for every label."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


@dataclass(frozen=True)
class Writing:
    """How figures are written: as which files, and who is told of each before it is made."""

    formats: Sequence[str] = USUAL_FORMATS
    tell: Callable[[str], None] = lambda said: None


_WRITING: ContextVar[Writing | None] = ContextVar("writing", default=None)


@contextmanager
def writing(formats: Sequence[str] = USUAL_FORMATS, tell: Callable[[str], None] = lambda said: None) -> Iterator[None]:
    """Within, figures are written as these FORMATS, and `tell` hears of each."""
    token = _WRITING.set(Writing(tuple(formats), tell))
    try:
        yield
    finally:
        _WRITING.reset(token)


def save(drawing: Drawing, folder: Path) -> tuple[list[Path], str]:
    """Write the figure into the folder, as <name>.png and <name>.svg unless `writing` says otherwise.

    Returns the paths, and the SVG for a web page.
    """
    how = _WRITING.get() or Writing()
    how.tell(f"{folder.parent.name}: {drawing.name}")
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        # The salt also keeps the identifiers of two figures on one page apart.
        matplotlib.rcParams.update(STYLE | {"svg.hashsalt": f"dilatedem {drawing.name}"})
        images = {kind: _image(drawing, kind) for kind in dict.fromkeys([*how.formats, "svg"])}
    written = [folder / f"{drawing.name}.{kind}" for kind in how.formats]
    for path, kind in zip(written, how.formats, strict=True):
        write_bytes(path, images[kind])
    return written, inline_svg(images["svg"].decode())


def _image(drawing: Drawing, kind: str) -> bytes:
    image = io.BytesIO()
    metadata = FORMATS[kind] | ({} if kind == "png" else {"Title": drawing.title})
    drawing.figure.savefig(image, format=kind, dpi=PNG_DPI, metadata=metadata, bbox_inches="tight", pad_inches=0.06)
    return image.getvalue()


def inline_svg(text: str) -> str:
    """The svg element alone, without prolog, metadata and comments, as HTML takes it."""
    element = text[text.index("<svg") :]
    element = re.sub(r"<metadata>.*?</metadata>", "", element, flags=re.DOTALL)
    return re.sub(r"<!--.*?-->\s*", "", element, flags=re.DOTALL)


def file_name(text: str) -> str:
    """A structure's name or a case key as part of a file name."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", text).strip("_") or "unnamed"
