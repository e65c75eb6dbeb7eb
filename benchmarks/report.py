"""README.md of a folder of results: made from the two files of results alone."""

from pathlib import Path

from benchmarks.others import PAPER_STAGE
from benchmarks.plots import COST, STAGE
from benchmarks.results import grouped
from benchmarks.scenes import ALL, MODELS, SCENES
from benchmarks.targets import targets
from benchmarks.yardstick import PUBLISHED
from dilatedem.step.stages import STAGES

_HEAD = """# Benchmarks

Made by `python -m benchmarks`; do not edit. From the repository's root, on an idle machine:

```sh
python -m benchmarks           # scenes x models x sizes x threads: results.csv, this page, pictures; about ten minutes
python -m benchmarks --quick   # 200 floes, one thread, to the screen alone; under a minute
python -m benchmarks --all     # also start, files, memory, generation, the paper's case, a sweep, two threads on a busy machine
```

Three fixed scenes of 200 floes (`scenes/`), water, friction, contact history, ledger and load record on, open boundaries:
*drift*, 196 floes at 63 % concentration in a current of 0.3 m/s past a pile; *jam*, the same ice shoved up to the pile; *packed*,
195 floes at 97 %, at rest, nearly all face on face. Each settles for 0.2 s. Larger sizes are copies of the settled scene side by
side, each with its pile, so that the work per floe stays what it is. Two more the program makes itself: *field*, packed floes
of any number as `generate` numbers them, and *rocking*, 189 floes that a current presses between walls against a pile. The step is
1e-4 s everywhere; floes that nothing can touch take several of them in one, as in any run.

A figure is the best of all repeats (the median in brackets) of one stretch of steps, run again and again from the same state for at
least 0.3 s. Repeats come in three rounds, minutes apart, as machines have slow minutes and ratios compare figures of different
ones. The time of a step comes from the program's own loop; times by stage from a copy of that loop which looks at the clock between
stages, the clock's own 20-odd ns taken off."""


def _table(header: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(header) + " |", "| --- |" + " ---: |" * (len(header) - 1)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def _number(value: float | None, digits: int = 3) -> str:
    if value is None:
        return "–"
    text = f"{value:.{digits}g}"
    return f"{float(text):g}" if "e" in text else text


def _find(rows: list[dict], **wanted) -> dict | None:
    return next((row for row in rows if all(row[key] == value for key, value in wanted.items())), None)


def _ms(row: dict | None) -> str:
    return f"{_number(row['ms_per_step'])} ({_number(row['ms_per_step_median'])})" if row else "–"


def _machine(rows: list[dict]) -> str:
    last = rows[-1]
    dates = sorted(row["date"] for row in rows)
    layers = sorted({row["layer"] for row in rows} - {"none"})
    loads = [row["load"] for row in rows]
    return (
        f"Measured {dates[0].replace('T', ' ')} to {dates[-1].replace('T', ' ')} on {last['processor']}, {last['cores']} cores, "
        f"{last['system']}; dilatedem {last['program']}, Python {last['python']}, Numba {last['numba']}, NumPy {last['numpy']}; "
        f"threads by {', '.join(layers) or 'none'}. Processes that wanted to run meanwhile, this one included: {min(loads):.1f} to "
        f"{max(loads):.1f}."
    )


def _targets(rows: list[dict], others: list[dict]) -> str:
    lines = []
    for target in targets(rows, others):
        sign = "≥" if target.at_least else "≤"
        unit = f" {target.unit}" if target.unit != "x" else " ×"
        value = _number(target.value) + (unit if target.value is not None else "")
        lines.append([target.what, value, f"{sign} {target.must:g}{unit}", f"{sign} {target.aim:g}{unit}", target.verdict()])
    words = "`liu2015` on one thread unless it says otherwise."
    return "\n\n".join(["## Targets", words, _table(["", "measured", "must", "aim", ""], lines)])


def _against_others(rows: list[dict]) -> str:
    ours = {(scene, model): _find(rows, scene=scene, model=model, size=200, threads=1) for scene in SCENES for model in MODELS}
    lines = [[f"**dilatedem, {model}**", *(_ms(ours[scene, model]) for scene in SCENES)] for model in MODELS]
    asked = [ours[scene, "liu2015"] or {} for scene in SCENES]
    known = any(row.get("coal_ms") is not None for row in asked)
    if known:
        version = next(row["coal"] for row in asked if row.get("coal"))
        lines.append([f"coal {version} (geometry only), same minute", *(_number(row.get("coal_ms")) for row in asked)])
    lines += [[name, *(_number(value) for value in values)] for name, values in PUBLISHED.items()]
    text = (
        "coal is the yardstick: one distance for each pair of floes whose bounding boxes overlap and one collision for each "
        "contact of the same state, asked from Python, less what the same calls take on two spheres. "
        if known
        else "coal, the yardstick, was not installed: there are no figures of the same minute. "
    )
    return "\n\n".join([
        "## A step at 200 floes, ms, one thread", _table(["", *SCENES], lines),
        text + f"The rows below {'it' if known else 'our own'} are published figures, measured on the same kind of machine on "
        "another day: good for the order of magnitude, not for the last tenth.",
    ])  # fmt: skip


def _by_size(rows: list[dict]) -> str:
    parts = ["## By size and threads, ms a step", f"![cost of a floe-step by size]({COST})"]
    sizes = sorted({row["size"] for row in rows})
    columns = [(size, threads) for size in sizes for threads in (1, 2) if _find(rows, size=size, threads=threads)]
    lines = []
    for scene in ALL:
        for model in MODELS:
            found = [_find(rows, scene=scene, model=model, size=size, threads=threads) for size, threads in columns]
            if any(found):
                lines.append([f"{scene}, {model}", *(_number(row["ms_per_step"]) if row else "–" for row in found)])
    parts.append(_table(["", *(f"{grouped(size)} / {threads}" for size, threads in columns)], lines))
    return "\n\n".join(parts)


def _by_stage(rows: list[dict]) -> str:
    header = ["", "floes", "contacts", "listed pairs", "awake pairs", "floe-steps/s", "step", *STAGES]
    lines = []
    for row in sorted(rows, key=lambda row: (ALL.index(row["scene"]), MODELS.index(row["model"]), row["size"])):
        if row["threads"] == 1:
            lines.append([
                f"{row['scene']}, {row['model']}", grouped(row["floes"]), grouped(row["contacts"]), grouped(row["listed_pairs"]),
                grouped(round(row["awake_pairs"])), f"{row['particle_steps_per_s'] / 1e6:.2f}e6", _number(1e3 * row["ms_per_step"]),
                *(_number(row[f"{stage}_us"]) for stage in STAGES),
            ])  # fmt: skip
    words = (
        "One thread; the step as measured by the program's own loop, then its stages, µs a step. *search*: has a body moved so far "
        "that the list of pairs must be made anew, and that; *foresee*: which bodies nothing can touch for some steps; *drift*: "
        "half a kick and the move of the others; *wake*: which pairs may touch; *collide*: their shapes, distance, patch, "
        "forces; *float*: sums of contacts, buoyancy, drag, the other half of the kick; *record*: ledger, loads on structures, is "
        "an overlap too deep; *stride*: how many steps busy bodies may take in one, and what each step notes; *idle*: the "
        "long step of bodies that nothing touched."
    )
    return "\n\n".join(["## Where the time goes", words, f"![cost of a floe-step by stage]({STAGE})", _table(header, lines)])


def _paper(others: list[dict]) -> str:
    """The paper's case by stage; nothing where it was not measured."""
    values = {other["name"]: other["value"] for other in others}
    spent = {stage: values[PAPER_STAGE.format(stage)] for stage in STAGES if PAPER_STAGE.format(stage) in values}
    if not spent:
        return ""
    whole = sum(spent.values())
    words = f"The steps of the paper's case, 100 s of `cases/pile.toml`, take {whole:.2f} s, of which seconds and shares:"
    lines = [[f"{value:.2f}" for value in spent.values()], [f"{value / whole:.1%}" for value in spent.values()]]
    return words + "\n\n" + _table(list(spent), lines)


def _others(others: list[dict]) -> str:
    stages = {PAPER_STAGE.format(stage) for stage in STAGES}
    lines = [
        [other["note"], f"{_number(other['value'])} {other['unit']}", other["date"].replace("T", " ")]
        for other in others if other["name"] not in stages
    ]  # fmt: skip
    return "## What else a user waits for\n\n" + _table(["", "", "measured"], lines)


def page(rows: list[dict], others: list[dict]) -> str:
    """The page as Markdown."""
    parts = [_HEAD]
    if rows:
        parts += [_machine(rows), _targets(rows, others), _against_others(rows), _by_size(rows), _by_stage(rows)]
    if _paper(others):
        parts.append(_paper(others))
    if others:
        parts.append(_others(others))
    return "\n\n".join(parts) + "\n"


def write_page(rows: list[dict], others: list[dict], folder: Path) -> None:
    """README.md of the folder."""
    (folder / "README.md").write_text(page(rows, others), encoding="utf-8")
