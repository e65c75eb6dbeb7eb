"""Pictures of the results: what a floe-step costs by size, and which stage it goes to."""

from pathlib import Path

from benchmarks.results import grouped
from benchmarks.scenes import ALL, MODELS
from dilatedem.post.figures.canvas import BLACK, BLUE, GREEN, PNG_DPI, PURPLE, SKY, VERMILION, new_figure, styled
from dilatedem.step.stages import STAGES

COST, STAGE = "cost_by_size.png", "cost_by_stage.png"
_COLOURS = {"liu2015": BLUE, "consistent": VERMILION}
_LINES = {1: ("-", "o"), 2: ("--", "s")}
#: the stages that can be seen, with those that cannot under one colour
_STAGE_COLOURS = {
    "collide": VERMILION, "record": PURPLE, "drift": BLUE, "float": SKY, "idle": GREEN,
    "foresee": "#5b6770", "wake": BLACK,
}  # fmt: skip
_REST = "#b8bec4"


def _save(figure, path: Path) -> None:
    figure.savefig(path, dpi=PNG_DPI, metadata={"Software": None}, bbox_inches="tight", pad_inches=0.06)


def _panels(figure, rows: list[dict]):
    """Axes with their scene, for the scenes that there are results of."""
    scenes = [scene for scene in ALL if any(row["scene"] == scene for row in rows)]
    return zip(figure.subplots(1, len(scenes), squeeze=False)[0], scenes, strict=True)


@styled
def cost_by_size(rows: list[dict], path: Path) -> None:
    """us per floe-step against the number of floes: a panel for each scene, a line for each model and number of threads."""
    figure = new_figure(10.5, 3.4)
    for axes, scene in _panels(figure, [row for row in rows if row["scene"] != "rocking"]):  # it has one size
        for model in MODELS:
            for threads, (line, marker) in _LINES.items():
                mine = sorted(
                    (row["floes"], row["us_per_floe_step"]) for row in rows
                    if (row["scene"], row["model"], row["threads"]) == (scene, model, threads)
                )  # fmt: skip
                if mine:
                    label = f"{model}, {threads} thread{'s' * (threads > 1)}"
                    axes.plot(*zip(*mine, strict=True), line, marker=marker, color=_COLOURS[model], label=label)
        axes.set_xscale("log")
        axes.set_ylim(bottom=0.0)
        axes.set_title(scene)
        axes.set_xlabel("floes")
        axes.grid(True)
    figure.axes[0].set_ylabel("µs per floe and step")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    _save(figure, path)


@styled
def cost_by_stage(rows: list[dict], path: Path) -> None:
    """us per floe-step by stage on one thread: a panel for each scene, a bar for each model and size."""
    figure = new_figure(13.0, 3.8)
    mine = [row for row in rows if row["threads"] == 1]
    for axes, scene in _panels(figure, rows):
        here = sorted((row for row in mine if row["scene"] == scene), key=lambda row: (MODELS.index(row["model"]), row["size"]))
        names = [f"{row['model']} {grouped(row['size'])}" for row in here]
        left = [0.0] * len(here)
        seen = [*_STAGE_COLOURS, "the rest"]
        for stage in seen:
            parts = (stage,) if stage in STAGES else tuple(set(STAGES) - set(_STAGE_COLOURS))
            widths = [sum(row[f"{part}_us"] for part in parts) / row["floes"] for row in here]
            axes.barh(names, widths, left=left, height=0.7, color=_STAGE_COLOURS.get(stage, _REST), label=stage)
            left = [start + width for start, width in zip(left, widths, strict=True)]
        axes.invert_yaxis()
        axes.set_title(scene)
        axes.set_xlabel("µs per floe and step")
        axes.grid(True, axis="x")
        axes.tick_params(axis="y", length=0)
        axes.locator_params(axis="x", nbins=4)
        if axes is not figure.axes[0]:
            axes.set_yticklabels([])
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    _save(figure, path)
