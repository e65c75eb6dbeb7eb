"""The command line: exit codes, where messages go, what is called with what. The simulation is a stand-in."""

import io
import json
import os
import subprocess
import sys
import types
from pathlib import Path

import pytest
from typer.testing import CliRunner

import dilatedem.run
from dilatedem.case.load import load
from dilatedem.cli import _clock, app
from dilatedem.errors import CaseError, Interrupted, SimulationStopped
from dilatedem.post.figures import canvas

PILE = Path(__file__).parents[2] / "cases" / "pile.toml"


@pytest.fixture
def simulation(monkeypatch, tmp_path):
    """A simulation that notes its calls, writes a summary, and fails with `fault` where a test sets one."""
    monkeypatch.chdir(tmp_path)
    fake = types.SimpleNamespace(calls=[], fault=None)

    def run(case, out, **options):
        fake.calls.append((case, out, options))
        if fake.fault is not None:
            raise fake.fault
        out.mkdir(parents=True)
        loads = {"pile": {"fh_max_N": 85321.0, "fh_max_time_s": 43.2}}
        summary = {"status": "completed", "simulated_s": 100.0, "wall_s": 83.4, "loads": loads}
        (out / "summary.json").write_text(json.dumps(summary))

    fake.run = run
    fake.TRIAL_S, fake.told = 0.5, dict
    fake.check = lambda case, trial_s: [("floes", 200), ("time step", 5.12345678e-5)]
    for name in ("loop", "foretell"):
        monkeypatch.setitem(sys.modules, f"dilatedem.run.{name}", fake)
        monkeypatch.setattr(dilatedem.run, name, fake, raising=False)
    return fake


def invoke(*arguments: str, stdin: str | None = None):
    return CliRunner().invoke(app, [str(argument) for argument in arguments], input=stdin)


def test_run_passes_the_case_and_says_where_the_results_are(simulation):
    result = invoke("run", PILE, "--set", "water.velocity=[0.5,0]", "--threads", "2")
    assert result.exit_code == 0
    assert result.stdout == (
        "runs/pile: 100 s simulated in 1 min 23 s; peak load on pile 85.3 kN at 43.20 s\n"
    )
    [(case, out, options)] = simulation.calls
    assert case == load(PILE, ["water.velocity=[0.5,0]"])
    assert out == Path("runs/pile")
    assert options == {"threads": 2, "resume": False, "overwrite": False, "quiet": False}


def test_run_from_standard_input_quietly(simulation, monkeypatch):
    result = invoke("run", "-", "--quiet", "--overwrite", stdin="[ice]\ndensity = 900\n")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")
    [(case, out, options)] = simulation.calls
    assert (case.ice.density, out) == (900.0, Path("runs/case"))
    assert options["quiet"] and options["overwrite"]


@pytest.mark.parametrize(
    ("fault", "code"),
    [
        (CaseError("runs/pile: holds a run"), 2),
        (SimulationStopped("bodies 3 and 7 overlap"), 3),
        (Interrupted("state saved"), 130),
        (KeyboardInterrupt(), 130),
        (PermissionError(13, "Permission denied", "runs/pile"), 2),
        (OSError(28, "No space left on device", "runs/pile/run.h5"), 3),
        (OSError(28, "a paragraph\nby HDF5"), 3),
    ],
)
def test_known_faults_end_with_their_code_and_no_traceback(simulation, fault, code):
    simulation.fault = fault
    result = invoke("run", PILE)
    assert result.exit_code == code
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_a_full_disk_is_told_with_the_file_and_the_way_on(simulation):
    simulation.fault = OSError(28, "a paragraph\nby HDF5", "runs/pile/restart.h5")
    found = invoke("run", PILE).stderr
    assert found == "runs/pile/restart.h5: No space left on device; make room and go on with --resume\n"


def test_an_unknown_fault_keeps_its_traceback(simulation):
    simulation.fault = ZeroDivisionError("a bug")
    assert isinstance(invoke("run", PILE).exception, ZeroDivisionError)


def test_a_wrong_case_is_answered_before_anything_is_called(simulation, tmp_path):
    result = invoke("run", PILE, "--set", "contact.friction=-0.1")
    assert result.exit_code == 2
    assert result.stderr == "--set contact.friction: contact.friction = -0.1: must be at least 0\n"
    assert simulation.calls == []
    assert list(tmp_path.iterdir()) == []


def test_wrong_command_lines(simulation):
    for arguments in (["run"], ["walk"], ["run", PILE, "--threads", "0"], ["run", PILE, "--nonsense"]):
        assert invoke(*arguments).exit_code == 2
    result = invoke("run", PILE, "--resume", "--overwrite")
    assert (result.exit_code, result.stderr) == (2, "give either --resume or --overwrite, not both\n")


def test_check_prints_labels_and_values(simulation):
    result = invoke("check", PILE)
    assert result.stdout == "floes      200\ntime step  5.12346e-05\n"


def test_generate(simulation, monkeypatch):
    fake = types.SimpleNamespace(generate=lambda case, out: {"floes": 200, "size": {"mean_m": 2.8}})
    monkeypatch.setitem(sys.modules, "dilatedem.generate", fake)
    result = invoke("generate", PILE, "--out", "here")
    assert result.exit_code == 0
    assert result.stdout == (
        "floes        200\nsize.mean_m  2.8\nfield.vtu, field.png and field.json are in here\n"
    )


def test_post_and_info(simulation, monkeypatch, tmp_path):
    asked = []

    def fake_post(folders, **options):
        asked.append((folders, {option: value for option, value in options.items() if value not in (None, "")}))
        return [tmp_path / "figures" / "field.png", tmp_path / "report.html"]

    fake = types.SimpleNamespace(post=fake_post, info=lambda folder: f"{folder.name} is a run", canvas=canvas)
    monkeypatch.setitem(sys.modules, "dilatedem.post", fake)
    result = invoke("info", tmp_path / "none")
    assert (result.exit_code, result.stderr) == (2, f"{tmp_path}/none: no such folder\n")
    (tmp_path / "summary.json").touch()
    result = invoke("post", tmp_path, "--prepared-by", "A. Maker", "--document", "IL-12 rev. B")
    assert (result.exit_code, result.stdout) == (0, f"{tmp_path / 'report.html'}\n")
    assert asked == [([tmp_path], {"prepared_by": "A. Maker", "document": "IL-12 rev. B"})]
    invoke("post", tmp_path, "--from", "5m", "--to", "30m", "--threshold", "2e4", "--gap", "2")
    assert asked[1:] == [([tmp_path], {"start": "5m", "end": "30m", "threshold": 2e4, "gap": 2.0})]
    assert invoke("info", tmp_path).stdout == f"{tmp_path.name} is a run\n"


def test_sweep_passes_its_options(simulation, monkeypatch):
    asked = {}
    table = Path("runs/pile-sweep/sweep.csv")
    monkeypatch.setattr("dilatedem.sweeps.sweep.sweep", lambda case, **options: asked.update(options) or table)
    options = "--vary a=1 --vary b=2 --seeds 3 --jobs 2 --set c=1"
    result = invoke("sweep", PILE, *options.split())
    assert result.exit_code == 0
    assert asked == {
        "vary": ["a=1", "b=2"], "seeds": 3, "jobs": 2, "scheduler": None, "out": Path("runs/pile-sweep"),
        "resume": False, "check_all": False, "overrides": ["c=1"],
    }


def test_schema_is_json():
    assert json.loads(invoke("schema").stdout)["title"] == "Case"


def test_help_shows_examples():
    for command in ("run", "generate", "check", "post", "info", "sweep", "init", "export", "paraview"):
        text = invoke(command, "-h").stdout
        assert f"dilatedem {command} " in text
        assert "Example" in text


def test_help_gives_no_word_for_the_value_of_a_switch():
    for command in ([], ["run"], ["sweep"], ["post"], ["init"]):
        text = invoke(*command, "--help").stdout
        assert "<bool>" not in text and "BOOLEAN" not in text and "--help" in text


def test_help_and_version_import_no_physics():
    code = (
        "import sys\nfrom dilatedem.cli import main\nsys.argv = ['dilatedem', sys.argv[1]]\n"
        "try:\n    main()\nfinally:\n    print(sorted({'numpy', 'numba', 'pydantic'} & set(sys.modules)))"
    )
    for option in ("--help", "--version"):
        command = [sys.executable, "-c", code, option]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert done.stdout.endswith("[]\n")
        assert dilatedem.__version__ in done.stdout or option == "--help"


def test_module_is_a_command():
    done = subprocess.run(
        [sys.executable, "-m", "dilatedem.cli", "run", "nowhere.toml"], capture_output=True, text=True
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "nowhere.toml: no such case file\n"


def test_output_that_nobody_reads_ends_the_program_without_a_word(tmp_path):
    """As behind `head`: whether more was to come, or all of it was still in the buffer."""
    for arguments in (["schema"], ["init", "small", "--out", str(tmp_path / "case.toml")]):
        read, write = os.pipe()
        os.close(read)
        command = [sys.executable, "-m", "dilatedem", *arguments]
        done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
        os.close(write)
        assert (done.returncode, done.stderr) == (141, "")
    closed = subprocess.run(f"{sys.executable} -m dilatedem schema >&-", shell=True, stderr=subprocess.PIPE, text=True, check=False)
    assert (closed.returncode, closed.stderr) == (0, "")


def test_times_are_readable():
    assert [_clock(seconds) for seconds in (3.14, 59.97, 83.4, 3600, 7322)] == [
        "3.1 s", "1 min 0 s", "1 min 23 s", "1 h 0 min", "2 h 2 min"
    ]


def test_pipe_as_standard_input(simulation, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    assert invoke("check", "-", stdin="").exit_code == 0


def test_ctrl_c_while_the_program_loads_prints_no_traceback():
    code = (
        "import sys\nfrom dilatedem.__main__ import main\n"
        "class Pressed:\n"
        "    def find_spec(self, name, *more):\n"
        "        if name == 'typer':\n            raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Pressed())\nmain()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


@pytest.mark.parametrize(
    ("argument", "said"),
    [
        (b"title=\xff", "argument 4, title=\\udcff: is not UTF-8 text; rename the file or write the value in UTF-8\n"),
        (b"title=\x1b[31m", "argument 4, title=\\x1b[31m: holds a control character; leave it out\n"),
        (b"title=\xe2\x80\xae", "argument 4, title=\\u202e: holds a control character; leave it out\n"),
    ],
)
def test_arguments_that_are_no_text(argument, said):
    command = [sys.executable, "-m", "dilatedem", "check", str(PILE), "--set"]
    done = subprocess.run([*command, argument], capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr.decode()) == (2, b"", said)


def test_a_folder_that_is_no_text_is_not_made(tmp_path):
    command = [sys.executable, "-m", "dilatedem", "generate", str(PILE), "--out", bytes(tmp_path / "f") + b"\xff"]
    done = subprocess.run(command, capture_output=True, check=False)
    assert (done.returncode, list(tmp_path.iterdir())) == (2, [])
    assert done.stderr.startswith(b"argument 4, ") and b"is not UTF-8 text" in done.stderr
    assert done.stderr.count(b"\n") == 1


def test_what_is_printed_cannot_command_a_terminal(simulation):
    simulation.fault = SimulationStopped("the file \x1b[2J said \u202e so\nand more")
    result = invoke("run", PILE)
    assert (result.exit_code, result.stderr) == (3, "the file \\x1b[2J said \\u202e so\nand more\n")
