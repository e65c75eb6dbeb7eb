"""The ice field alone: field.vtu, field.png and field.json, without a simulation."""

import io
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, SimulationStopped
from dilatedem.files.atomic import write_bytes
from dilatedem.files.faults import told_as
from dilatedem.files.whose import refuse_foreign, refuse_links
from dilatedem.output.folder import holds_run
from dilatedem.output.snapshots.vtu import write_shapes
from dilatedem.output.summary import write_json
from dilatedem.scene.facts import asked_areas, field_facts
from dilatedem.scene.place import Scene, compose

SIZE_MAP = "viridis"
#: of a size, differences that are none
ALIKE = 1e-6
#: inch, that the arrow and the words of a current or a wind take above the plan
FLOW = 0.25
FACTS = "field.json"
FILES = (FACTS, "field.vtu", "field.png")


def generate(case: Case, out: Path, *, overwrite: bool = False) -> dict:
    """Write the ice field of `case` into the folder `out`; what is returned stands in field.json.

    An earlier field in the folder is replaced. Raises CaseError, with nothing written, if the folder holds a
    run (unless `overwrite`), a file of somebody else in the way, or the field cannot be built; SimulationStopped for what the disk
    refuses while it is written.
    """
    out = Path(out)
    with told_as(CaseError):
        if holds_run(out) and not overwrite:
            raise CaseError(
                f"{out}: holds a run, which a new field could contradict; choose another folder (--out)"
            )
        refuse_links(out / name for name in FILES)
        if not _holds_field(out):
            refuse_foreign(out, (out / name for name in FILES), "field")
    scene = compose(case)
    facts = field_facts(case, scene)
    draw_picture = _picture(case, scene)

    with told_as(CaseError):
        out.mkdir(parents=True, exist_ok=True)
    with told_as(SimulationStopped):
        write_json(out / FACTS, facts)  # first: it says whose the others are
        write_shapes(
            out / "field.vtu",
            [shape.outer for shape in scene.shapes],
            scene.position,
            scene.orientation,
            {"body": np.arange(scene.count), "floe_size": np.sqrt(scene.floe_area())},
            order=scene.order,
        )
        write_bytes(out / "field.png", draw_picture())
    return facts


def _holds_field(folder: Path) -> bool:
    """Whether `generate` has written into this folder before."""
    try:
        facts = json.loads((folder / FACTS).read_bytes())
    except (OSError, ValueError):
        return False
    return isinstance(facts, dict) and "concentration_without_left_out" in facts


def _picture(case: Case, placed: Scene) -> Callable[[], bytes]:
    """The plan of the field, floes coloured by size, and their sizes where the case asks for some; call the result for the bytes of
    a PNG.
    """
    # Imported here: matplotlib takes half a second, which a wrong case should not wait for.
    from dilatedem.post.figures import canvas, plan
    from dilatedem.post.figures.field import panel_height
    from dilatedem.post.figures.sizes import draw_sizes
    from dilatedem.post.read import RunFolder
    from dilatedem.results.archive import PlanOutline
    from dilatedem.results.whole import together

    # The figures of a run are drawn from its folder; this is one that holds nothing but the case.
    scene = RunFolder(
        path=Path(),
        case=case.model_dump(mode="json"),
        summary={},
        forces={},
        energy={},
        snapshots=[],
        outlines={
            structure.name: PlanOutline(sketch.outline, sketch.bounded)
            for structure, sketch in ((each, each.about.sketch(math.hypot(*case.domain.size))) for each in placed.structures)
            if sketch
        },
    )

    @canvas.styled
    def draw() -> canvas.Drawing:
        first, owner = np.unique(placed.joints.first(), return_inverse=True)
        outlines, asked = together(list(placed.outlines), owner), asked_areas(case, placed)
        view = plan.choose_view(scene, [outlines])
        height = panel_height(view, 5.6) + FLOW * len(scene.flows)
        figure = canvas.new_figure(6.4 if asked is None else 6.4 + 3.2, height)
        axes, *beside = np.ravel(figure.subplots(1, 1 if asked is None else 2, width_ratios=None if asked is None else [2.0, 1.0]))
        plan.dress(axes, scene, view, water=canvas.WATER)
        plan.draw_domain(axes, scene)
        size = np.sqrt(placed.floe_area()[first])
        style = {"cmap": SIZE_MAP, **_scale(size), "edgecolors": canvas.ICE_EDGE, "linewidths": 0.4}
        floes = plan.draw_floes(axes, scene, view, outlines, array=size, **style)
        plan.draw_structures(axes, scene)
        plan.draw_flows(axes, scene)
        bar = figure.colorbar(floes, ax=axes, shrink=0.85, pad=0.02)
        bar.set_label("Floe size, root of the plan area (m)")
        axes.set_title(_title(case, placed))
        for panel in beside:
            draw_sizes(panel, asked, placed.field.every_area)
        return canvas.Drawing("field", "Ice field", "", figure)

    drawing = draw()

    def picture() -> bytes:
        image = io.BytesIO()
        drawing.figure.savefig(image, format="png", dpi=canvas.PNG_DPI, metadata={"Software": None})
        return image.getvalue()

    return picture


def _scale(size: np.ndarray) -> dict:
    """Ends of the scale of colours where all floes are of one size (n,) [m], so that no round-off is drawn."""
    if not len(size) or np.ptp(size) > ALIKE * size.max():
        return {}
    return {"clim": (0.9 * size.mean(), 1.1 * size.mean())}


def _title(case: Case, placed: Scene) -> str:
    floes = len(placed.field.floe_area)
    origin = f" of {Path(case.field.file).name}" if case.field.source == "file" else ""
    parts = [] if case.field.source == "bodies" else [f"{floes} floes{origin}"]
    if case.body:
        parts.append(f"{len(case.body)} {'body' if len(case.body) == 1 else 'bodies'}")
    return " and ".join(parts) + (f", seed {case.field.seed}" if case.field.source == "voronoi" else "")
