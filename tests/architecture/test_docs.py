"""Pages made from the code are those that the code makes now."""

from pathlib import Path

from dilatedem.case import meanings, reference

ROOT = Path(__file__).parents[2]


def test_case_file_page_is_current():
    written = (ROOT / reference.PAGE).read_text(encoding="utf-8")
    assert written == reference.page(), "stale: run `python -m dilatedem.case.reference`"


def test_meanings_of_keys_in_reports_are_current():
    written = (ROOT / meanings.FILE).read_text(encoding="utf-8")
    assert written == meanings.text(), "stale: run `python -m dilatedem.case.reference`"
