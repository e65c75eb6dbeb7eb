"""The pages as a site: it builds without a warning, so that every link leads somewhere, and every page is in its menu."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted(page.relative_to(ROOT) for page in (ROOT / "docs").rglob("*.md"))


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    pytest.importorskip("sphinx")
    pytest.importorskip("furo")
    pytest.importorskip("myst_parser")
    folder = tmp_path_factory.mktemp("site")
    options = ["-q", "-W", "--keep-going", "-c", "docs", "-d", folder / "doctrees"]
    command = [sys.executable, "-m", "sphinx", *options, ".", folder / "html"]
    # no network: whoever asks for it is sent to a port where nobody listens
    nowhere = {name: "http://127.0.0.1:9" for name in ("http_proxy", "https_proxy", "HTTP_PROXY", "HTTPS_PROXY")}
    built = subprocess.run(command, cwd=ROOT, env=os.environ | nowhere, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    return folder / "html"


def test_every_page_is_in_the_menu(site):
    front = site / "docs/index.html"
    menu = re.search(r'<div class="sidebar-tree">(.*?)\n</div>', front.read_text(encoding="utf-8"), re.DOTALL)[1]
    linked = {(front.parent / href).resolve() for href in re.findall(r'href="([^"#]+)', menu) if "://" not in href}
    pages = {site / page.with_suffix(".html") for page in PAGES if page.name != "index.md"}
    assert len(pages) > 20 and pages <= linked | {front}, sorted(map(str, pages - linked))


def test_pages_of_a_site_need_no_network(site):
    for page in PAGES:
        text = (site / page.with_suffix(".html")).read_text(encoding="utf-8")
        assert not re.findall(r'(?:<script[^>]*src|<link[^>]*href|<img[^>]*src)="(https?:[^"]*)"', text), page


def test_docstrings_of_the_public_names_stand_on_the_page_of_the_api(site):
    text = (site / "docs/api.html").read_text(encoding="utf-8")
    page = (ROOT / "docs/api.md").read_text(encoding="utf-8")
    names = re.findall(r"^ *\.\. auto(?:class|function|exception):: (\S+)$", page, re.MULTILINE)
    assert len(names) > 20
    for name in names:
        assert f'id="{name}"' in text or f'id="dilatedem.{name.rpartition(".")[2]}"' in text, name
