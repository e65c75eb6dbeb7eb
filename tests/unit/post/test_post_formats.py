"""`post --format`, `--open` and its progress, on a made-up run."""

import pytest
from typer.testing import CliRunner

from dilatedem.cli import app
from dilatedem.post.figures import canvas

HEADS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}


def invoke(*arguments):
    return CliRunner().invoke(app, ["post", *map(str, arguments)])


@pytest.mark.parametrize("kinds", [(), ("pdf",), ("svg", "pdf", "svg")])
def test_figures_are_written_as_asked_and_the_report_has_them_all(kinds, make_run, tmp_path):
    run = make_run(tmp_path / "run", duration=2.0, snapshots=False)
    done = invoke(run, *(f"--format={kind}" for kind in kinds))
    assert done.exit_code == 0, done.stderr
    written = [path for path in (run / "figures").iterdir()]
    expected = set(kinds or ("png", "svg"))
    assert {path.suffix[1:] for path in written} == expected
    names = {path.stem for path in written}
    assert len(written) == len(names) * len(expected) and "force_pile" in names
    for path in written:
        assert path.read_bytes().startswith(HEADS[path.suffix[1:]])
    assert (run / "report.html").read_text().count("<svg") >= len(names)


def test_a_pdf_is_the_same_every_time(make_run, tmp_path):
    run = make_run(tmp_path / "run", duration=2.0, snapshots=False)
    invoke(run, "--format", "pdf")
    first = (run / "figures" / "force_pile.pdf").read_bytes()
    invoke(run, "--format", "pdf")
    assert (run / "figures" / "force_pile.pdf").read_bytes() == first


def test_a_format_that_there_is_not(make_run, tmp_path):
    run = make_run(tmp_path / "run", duration=2.0, snapshots=False)
    done = invoke(run, "--format", "gif")
    assert (done.exit_code, done.stderr) == (2, "--format gif: must be one of png, svg, pdf\n")
    assert not (run / "figures").exists() and not (run / "report.html").exists()


def test_every_figure_is_told_of_before_it_is_made(make_run, tmp_path):
    from dilatedem.post import post

    run, told = make_run(tmp_path / "run", duration=2.0, snapshots=False), []
    with canvas.writing(("png",), told.append):
        written = post([run])
    assert told == [f"run: {path.stem}" for path in written if path.suffix == ".png"]


def test_a_line_now_and_then_off_a_terminal(make_run, tmp_path, monkeypatch):
    monkeypatch.setattr("dilatedem.commands.manners.LINE_INTERVAL_S", 0.0)
    run = make_run(tmp_path / "run", duration=2.0, snapshots=False)
    assert "run: force_pile\n" in invoke(run).stderr
    monkeypatch.setattr("dilatedem.commands.manners.LINE_INTERVAL_S", 600.0)
    assert invoke(run).stderr == ""


@pytest.mark.parametrize("there", [True, False])
def test_the_report_is_opened(there, make_run, tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr("webbrowser.open", lambda address: asked.append(address) or there)
    run = make_run(tmp_path / "run", duration=2.0, snapshots=False)
    done = invoke(run, "--open")
    assert asked == [(run / "report.html").as_uri()] and done.exit_code == 0
    assert ("there is no browser here" in done.stderr) != there
    invoke(run)
    assert len(asked) == 1
