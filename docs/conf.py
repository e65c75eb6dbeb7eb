"""The site of these pages: `sphinx-build -W -c docs . site`, from the top of the repository, so that links are those of files."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))  # the package of this tree, whatever is installed

from dilatedem import __version__  # noqa: E402

project, release = "dilatedem", __version__
extensions = ["myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
root_doc = "docs/index"
include_patterns = ["docs/**.md", "validation/**.md", "benchmarks/*.md", "CHANGELOG.md", "CONTRIBUTING.md"]
exclude_patterns = ["validation/reliability/fuzz.md"]  # a table that a script writes, for its page
highlight_language = "none"
myst_heading_anchors = 4  # those of a code host

default_role = "code"  # docstrings are Markdown
autodoc_default_options = {"members": True, "member-order": "bysource"}
autodoc_typehints = "signature"

html_theme = "furo"
html_title = f"dilatedem {release}"
html_static_path = ["static"]
html_extra_path = ["front"]  # leads to docs/index.html
html_css_files = ["site.css"]
html_copy_source = html_show_copyright = False

#: pages of contents, and how their lines begin of which the links make the site's menu
CONTENTS = {"docs/index": "* ", "docs/cases/README": "| ", "validation/README": ""}
HEADING, LINK = re.compile(r"^## (.+)$"), re.compile(r"\]\(([^)#:]+\.md)\)")


def contents(page: str, text: str) -> str:
    """Menus of a page of contents: for each heading of second order the pages below it, in the order of their first links."""
    menus, seen = {"": []}, set()
    for line in text.splitlines():
        if found := HEADING.match(line):
            menus[found[1]] = []
        for link in LINK.findall(line) if line.startswith(CONTENTS[page]) else []:
            name = "/" + (ROOT / page).parent.joinpath(link).resolve().relative_to(ROOT).with_suffix("").as_posix()
            if name not in seen:
                seen.add(name)
                menus[list(menus)[-1]].append(name)
    return "".join(menu(heading, pages) for heading, pages in menus.items() if pages)


def menu(heading: str, pages: list[str]) -> str:
    options = [":hidden:", *([f":caption: {heading}"] if heading else [])]
    return "\n".join(["", "```{toctree}", *options, "", *pages, "```", ""])


def add_contents(app, page: str, source: list[str]) -> None:
    if page in CONTENTS:
        source[0] += contents(page, source[0])


def setup(app) -> None:
    app.connect("source-read", add_contents)
