"""Pages made from the code are those that the code makes now."""

from pathlib import Path

from dilatedem.case import reference

ROOT = Path(__file__).parents[2]


def test_case_file_page_is_current():
    written = (ROOT / reference.PAGE).read_text(encoding="utf-8")
    assert written == reference.page(), "stale: run `python -m dilatedem.case.reference`"
