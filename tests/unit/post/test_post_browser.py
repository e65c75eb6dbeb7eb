"""The report in a real browser: on a screen, on a telephone, on paper."""

import io
import re

import pypdf
import pytest
from test_post_sweep import write_sweep

from dilatedem.post import post
from tests import chromium

BROWSER = chromium.find()
pytestmark = pytest.mark.skipif(BROWSER is None, reason=f"no Chromium is installed; {chromium.VARIABLE} names one elsewhere")

A4, LETTER = (210.0, 297.0), (215.9, 279.4)  # mm
HISTORY, PLAN = "#force_pile .live", "#plan .live"


@pytest.fixture(scope="module")
def report(make_run, tmp_path_factory):
    folder = make_run(tmp_path_factory.mktemp("browser") / "run")
    post([folder], prepared_by="A. Maker")
    return folder / "report.html"


@pytest.fixture(scope="module")
def page():
    with chromium.Page(BROWSER) as opened:
        yield opened


def span(page):
    return tuple(float(page.value(f"document.querySelector('{HISTORY}').dataset.{end}")) for end in ("from", "to"))


def test_page_asks_for_nothing_and_has_nothing_to_complain_of(page, report):
    page.open(report)
    page.value("document.querySelectorAll('.live button, .live input[type=checkbox]').forEach((each) => each.click())")
    assert page.complaints() == []
    assert page.asked_for() == [report.as_uri()]


def test_history_zooms_by_wheel_where_the_pointer_is_and_is_dragged(page, report):
    page.open(report)
    left, top, width, height = page.place(f"{HISTORY} canvas")
    assert span(page) == (0.0, pytest.approx(10.0))
    x, y = left + 0.5 * width, top + 0.5 * height
    for _ in range(6):
        page.wheel(x, y, -120)
    start, end = span(page)
    assert end - start == pytest.approx(10.0 * 0.8**6, rel=1e-6)
    assert start < 5.0 < end and start > 0.0
    page.drag((x, y), (x + 0.1 * width, y))
    assert span(page)[0] < start and span(page)[1] - span(page)[0] == pytest.approx(end - start)
    for _ in range(20):
        page.wheel(x, y, 120)
    assert span(page) == (0.0, pytest.approx(10.0))


def test_page_scrolls_on_over_a_history_that_shows_all(page, report):
    page.open(report)
    left, top, width, height = page.place(f"{HISTORY} canvas")
    before = page.value("scrollY")
    page.wheel(left + 0.5 * width, top + 0.5 * height, 120)
    page.wait_for(f"scrollY > {before}")
    assert span(page) == (0.0, pytest.approx(10.0))


def test_history_zooms_by_keys_and_buttons(page, report):
    page.open(report)
    page.value(f"document.querySelector('{HISTORY}').focus()")
    page.press("+")
    page.press("+")
    assert span(page) == (pytest.approx(3.75), pytest.approx(6.25))
    page.press("ArrowRight")
    assert span(page) == (pytest.approx(4.25), pytest.approx(6.75))
    page.press("-")
    assert span(page)[1] - span(page)[0] == pytest.approx(5.0)
    page.press("Home")
    assert span(page) == (0.0, pytest.approx(10.0))
    page.value(f"[...document.querySelectorAll('{HISTORY} button')].find((each) => each.textContent === 'highest').click()")
    start, end = span(page)
    assert end - start == pytest.approx(1.0)
    peak = float(re.search(r"highest horizontal force.*?at ([\d.]+) s", report.read_text(encoding="utf-8"), re.DOTALL)[1])
    assert start < peak < end
    said = page.value(f"document.querySelector('{HISTORY} .said').textContent")
    assert "Highest horizontal force" in said and f"{peak:g} s" in said


def test_history_zooms_between_two_fingers(page, report):
    page.open(report, width=390, height=844)
    left, top, width, height = page.place(f"{HISTORY} canvas")
    y, middle = top + 0.4 * height, left + 0.5 * width
    page.touch([(middle - 40, y), (middle + 40, y)], [(middle - 80, y), (middle + 80, y)], [(middle - 120, y), (middle + 120, y)])
    start, end = span(page)
    assert end - start == pytest.approx(10.0 / 3.0, rel=0.05)
    assert start > 1.0 and end < 9.0


def test_history_is_drawn_in_its_colours(page, report):
    """The canvas holds what the static figure does: a band, a line, text."""
    page.open(report)
    colours = page.value(
        f"(() => {{ const c = document.querySelector('{HISTORY} canvas'), seen = {{}};"
        " const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        " for (let i = 0; i < d.length; i += 4) { const k = [d[i], d[i + 1], d[i + 2]].join(); seen[k] = (seen[k] || 0) + 1; }"
        " return seen; })()"
    )
    assert colours.get("86,180,233", 0) > 50 and colours.get("213,94,0", 0) > 50


def test_ice_moves(page, report):
    page.open(report)
    times = [page.value(f"document.querySelector('{PLAN}').dataset.time")]
    drawn = [page.value(f"document.querySelector('{PLAN} canvas').toDataURL()")]
    page.value(f"document.querySelector('{PLAN} button').click()")
    page.wait_for(f"document.querySelector('{PLAN}').dataset.time === '10'")
    page.wait_for(f"document.querySelector('{PLAN} button').getAttribute('aria-label') === 'play'")  # it ends there
    times.append(page.value(f"document.querySelector('{PLAN}').dataset.time"))
    drawn.append(page.value(f"document.querySelector('{PLAN} canvas').toDataURL()"))
    assert times == ["0", "10"] and drawn[0] != drawn[1]
    page.value(f"{{ const s = document.querySelector('{PLAN} input'); s.value = 1; s.dispatchEvent(new Event('input')); }}")
    assert page.value(f"document.querySelector('{PLAN} output').textContent") == "5 s"


def shown(page, selector):
    return page.value(f"document.querySelector('{selector}').checkVisibility()")


def test_without_scripts_figures_stand_as_they_were_drawn(page, report):
    page.open(report)
    assert shown(page, HISTORY) and not shown(page, "#force_pile .picture")
    page.open(report, script=False)
    assert shown(page, "#force_pile .picture svg") and shown(page, "#plan .picture svg")
    assert page.value("document.querySelectorAll('.live').length") == 0
    assert page.complaints() == []


def test_page_fits_a_telephone(page, report):
    page.open(report, width=390, height=844)
    assert page.value("document.documentElement.scrollWidth") <= 390
    outside = "(each) => each.getBoundingClientRect().right > 390.5 && !each.closest('.wide, .picture')"
    assert page.value(f"[...document.querySelectorAll('body *')].filter({outside}).map((each) => each.outerHTML)") == []
    assert page.value(f"document.querySelector('{HISTORY} canvas').clientWidth") > 300


def test_text_is_dark_on_white(page, report):
    page.open(report)
    texts = "[...document.querySelectorAll('body, body *:not(svg *)')]"
    colours = page.value(f"[...new Set({texts}.map((each) => getComputedStyle(each).color))]")
    for colour in colours:
        assert contrast([int(part) for part in re.findall(r"\d+", colour)[:3]]) >= 4.5, colour
    assert page.value("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"


def contrast(colour):
    """With white, as WCAG 2.1 has it."""
    linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in (part / 255 for part in colour)]
    return 1.05 / (0.05 + 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2])


@pytest.mark.parametrize("paper", [A4, LETTER], ids=["A4", "Letter"])
def test_it_prints_with_page_numbers_and_whole_figures(page, report, paper):
    page.open(report)
    printed = pypdf.PdfReader(io.BytesIO(page.pdf(*paper)))
    texts = [sheet.extract_text() for sheet in printed.pages]
    size = [float(side) * 25.4 / 72 for side in printed.pages[0].mediabox.upper_right]
    assert size == pytest.approx(paper, abs=0.5)
    assert 8 <= len(texts) <= 20
    for number, text in enumerate(texts, start=1):
        assert f"page {number} of {len(texts)}" in text and "Made-up ice against a made-up pile" in text
    assert "A. Maker" in texts[0] and "approved by" in texts[0] and "Ice loads\n" not in texts[0]
    captions = [number for number, text in enumerate(texts) for _ in re.findall(r"^Figure \d+\. ", text, re.MULTILINE)]
    assert len(captions) == report.read_text(encoding="utf-8").count("<figcaption>")
    assert not any("zoom by wheel" in text for text in texts)


@pytest.mark.parametrize("paper", [A4, LETTER], ids=["A4", "Letter"])
def test_no_figure_is_higher_than_a_page(page, report, paper):
    page.open(report)
    page.call("Emulation.setEmulatedMedia", media="print")
    width, height = (round((side - margin) / 25.4 * 96) for side, margin in zip(paper, (30, 36), strict=True))
    page.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
    heights = page.value("[...document.querySelectorAll('figure')].map((each) => each.getBoundingClientRect().height)")
    widths = page.value("[...document.querySelectorAll('figure svg')].map((each) => each.getBoundingClientRect().right)")
    page.call("Emulation.setEmulatedMedia", media="")
    assert len(heights) > 5 and max(heights) < height and max(widths) <= width + 0.5


@pytest.fixture(scope="module")
def sweep_report(tmp_path_factory):
    folder = write_sweep(tmp_path_factory.mktemp("browser") / "sweep")
    post([folder])
    return folder / "report.html"


def test_report_of_a_sweep_fits_a_telephone_and_paper(page, sweep_report):
    page.open(sweep_report, width=390, height=844)
    assert page.value("document.documentElement.scrollWidth") <= 390
    assert page.complaints() == [] and page.asked_for() == [sweep_report.as_uri()]
    texts = [sheet.extract_text() for sheet in pypdf.PdfReader(io.BytesIO(page.pdf(*A4))).pages]
    assert all(f"page {number} of {len(texts)}" in text for number, text in enumerate(texts, start=1))
    across = round((A4[0] - 30) / 25.4 * 96)
    page.call("Emulation.setEmulatedMedia", media="print")
    page.call("Emulation.setDeviceMetricsOverride", width=across, height=900, deviceScaleFactor=1, mobile=False)
    right = page.value("Math.max(...[...document.querySelectorAll('table')].map((each) => each.getBoundingClientRect().right))")
    page.call("Emulation.setEmulatedMedia", media="")
    assert right <= across + 0.5
