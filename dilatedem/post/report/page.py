"""report.html: one file that shows a run to somebody who was not there, and that somebody else can sign."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from dilatedem.files.atomic import write_text
from dilatedem.post.figures.canvas import Drawing, file_name
from dilatedem.post.overview import status_words
from dilatedem.post.read import RunFolder
from dilatedem.post.report.checks import checks, verdict_words
from dilatedem.post.report.events import event_rows, pressure_words
from dilatedem.post.report.front import Signed, basis_rows, headline, identity_rows
from dilatedem.post.report.histories import COLUMNS, history_data
from dilatedem.post.report.ice import field_rows
from dilatedem.post.report.inputs import input_groups
from dilatedem.post.report.iso import SHARE, bound_of, bound_rows
from dilatedem.post.report.limits import limits
from dilatedem.post.report.moving import moving_plan
from dilatedem.post.report.pack import as_json
from dilatedem.post.report.tables import (
    contact_table,
    energy_rows,
    fact_rows,
    load_rows,
    motion_rows,
    quantile_table,
    step_rows,
    unchecked,
    version_rows,
)

TEMPLATES = Path(__file__).with_name("templates")
#: first words of the names of figures, by the section of the report that shows them; all others are of loads
SECTIONS = {"blocks": ("extremes_",), "ice": ("field", "plan", "speed"), "loads": (), "events": ("hit_",), "energy": ("energy",)}

#: a unit of two symbols, which no line may end within
UNIT = re.compile(r"\b(?:[kM]?N|kJ) (?:m|s)\b")
NO_BREAK = "\N{NO-BREAK SPACE}"

ONE_HIT = (
    "These are no error bars of the run. They say how far this one hit, given the state before it, depends on the step; another "
    "history of the ice, of another step or another seed, has another highest hit. For that spread, run several seeds."
)

Figures = list[tuple[Drawing, str]]


def write_run_report(
    run: RunFolder, statistics: dict[str, Any], figures: Figures, signed: Signed | None = None, blocks: dict[str, Any] | None = None
) -> Path:  # fmt: skip
    """Write report.html of a run.

    statistics: as in summary.json under `post`; signed: what the front page says of who made it; blocks: `ensemble_tables` of the
    blocks that the run was cut into, None for none.
    """
    return render(
        "run.html",
        run.path / "report.html",
        title=run.title,
        status=status_words(run),
        message=run.summary.get("message") or "",
        doubts=statistics["doubts"],
        signed=signed or Signed(),
        identity=identity_rows(run),
        basis=basis_rows(run),
        headline=headline(run, statistics),
        loads=[load_section(run, name, entry) for name, entry in statistics["loads"].items()],
        blocks=blocks,
        one_hit=ONE_HIT,
        checks=(found := checks(run)),
        verdict=verdict_words(found),
        unchecked=unchecked(run.summary),
        limits=limits(run),
        field=field_rows(run),
        figures=by_section(figures, live_data(run, {drawing.name for drawing, _ in figures})),
        energy=energy_rows(run, statistics),
        contacts=contact_table(run),
        inputs=input_groups(run.case),
        facts_of_run=fact_rows(run),
        versions=version_rows(run.summary),
    )


def load_section(run: RunFolder, name: str, entry: dict[str, Any]) -> dict[str, Any]:
    """The tables of one structure; entry: its statistics."""
    rows, bound = load_rows(entry, run.moment_level), bound_of(run, name)
    fh = entry.get("fh")
    return {
        "name": name, "rows": rows + motion_rows(run.summary, name) if rows else [], "quantiles": quantile_table(entry),
        "bound": bound_rows(bound, fh["peak_N"], fh["quantiles_of_window_maxima_N"][SHARE]) if bound and fh else [],
        "step": step_rows(run.summary, name), "events": event_rows(run, name), "pressures": pressure_words(run, name, entry),
    }  # fmt: skip


def live_data(run: RunFolder, drawn: set[str]) -> dict[str, tuple[str, dict[str, Any]]]:
    """What the script of the page makes of figures, by their name: its kind and its data."""
    names = {name: f"force_{file_name(name)}" for name in run.forces if f"force_{file_name(name)}" in drawn}
    live = {figure: ("history", history_data(name, run.forces[name], COLUMNS // len(names))) for name, figure in names.items()}
    moving = moving_plan(run) if "plan" in drawn else None
    return live | ({"plan": ("plan", moving)} if moving else {})


def by_section(figures: Figures, live: dict[str, tuple[str, dict[str, Any]]]) -> dict[str, list[dict[str, Any]]]:
    """The figures of each section, numbered through in the order of the page."""
    sections: dict[str, Figures] = {section: [] for section in SECTIONS}
    for drawing, svg in figures:
        section = next((section for section, words in SECTIONS.items() if words and drawing.name.startswith(words)), "loads")
        sections[section].append((drawing, svg))
    numbered = iter(inline([figure for part in sections.values() for figure in part], live))
    return {section: [next(numbered) for _ in part] for section, part in sections.items()}


def render(template: str, path: Path, **content: Any) -> Path:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, trim_blocks=True, lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )  # fmt: skip
    environment.globals |= {"asset": asset, "css_text": css_text}
    environment.filters |= {"in_code": in_code, "typeset": typeset}
    write_text(path, environment.get_template(template).render(**content))
    return path


def asset(name: str) -> Markup:
    """A style sheet or script of the templates, as it stands."""
    return Markup((TEMPLATES / name).read_text(encoding="utf-8"))


def css_text(text: str) -> Markup:
    """A text as CSS takes it: whatever is no letter, digit or space by its number."""
    return Markup('"' + "".join(c if c.isascii() and (c.isalnum() or c == " ") else f"\\{ord(c):x} " for c in text) + '"')


def in_code(text: str) -> Markup:
    """A text in which `words` between accents are code."""
    parts = str(text).split("`")
    return Markup("").join(Markup("<code>{}</code>").format(part) if k % 2 else part for k, part in enumerate(parts))


def typeset(text: str) -> Markup:
    """A text as a table shows it: no break within a unit such as kN m, and C_R of ISO 19906 with its index."""
    whole = UNIT.sub(lambda unit: unit[0].replace(" ", NO_BREAK), str(text))
    return Markup("C<sub>R</sub>").join(Markup.escape(part) for part in whole.split("C_R"))


def inline(figures: Figures, live: dict[str, tuple[str, dict[str, Any]]] | None = None) -> list[dict[str, Any]]:
    """Figures as the templates take them; live: what the script makes of some of them."""
    shown = []
    for place, (drawing, svg) in enumerate(figures, start=1):
        kind, data = (live or {}).get(drawing.name, ("", None))
        shown.append({
            "number": place, "title": drawing.title, "caption": drawing.caption, "name": drawing.name, "svg": svg, "live": kind,
            "data": as_json(data) if data else "", "width": re.search(r'width="([\d.]+pt)"', svg)[1],
        })  # fmt: skip
    return shown
