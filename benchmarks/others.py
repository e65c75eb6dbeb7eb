"""What a user waits for besides stepping: the start, the files, a large field, the paper's case. Each in a process of its own."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.machine import describe

ROOT = Path(__file__).parents[1]
PAPER_CASE = ROOT / "cases" / "pile.toml"
#: name of the figure for a stage of its steps
PAPER_STAGE = "paper_{}_s"
#: floes of the large field, for memory and generation
LARGE = 100_000
#: simulated time over which the writing of files is timed, s: all of the case, as most of its contacts come late
FILES_DURATION = 100.0

#: dilatedem's command line up to the end of the first step of the run itself (kernels are tried out on one body before); then it
#: tells the time and ends
_FIRST_STEP = """
import os, time
from dilatedem import cli
command = cli.app
def app():
    from dilatedem.run.simulation import Simulation
    whole = Simulation.advance
    def first(self, steps):
        if self.model.floating < 2:
            return whole(self, steps)
        whole(self, 1)
        print("first step", time.time(), flush=True)
        os._exit(0)
    Simulation.advance = first
    command()
cli.app = app
cli.main()
"""

#: the paper's case for a while: from the opening of its folder to the end, all that is not `advance` (its replays included) counts
_FILES = """
import sys, time
from dilatedem.run import loop
from dilatedem.case.load import load
from dilatedem.run.simulation import Simulation
from pathlib import Path
spent = [0.0]
advance, opened = Simulation.advance, loop.RunFolder
def clocked(self, steps):
    spent[0] += time.perf_counter()
    status = advance(self, steps)
    spent[0] -= time.perf_counter()
    return status
def opening(*arguments, **options):
    spent[0] = -time.perf_counter()
    return opened(*arguments, **options)
loop.compile_kernels()
Simulation.advance, loop.RunFolder = clocked, opening
case = load(sys.argv[1], ["time.duration=" + sys.argv[2]])
began = time.perf_counter()
loop.run(case, Path(sys.argv[3]), quiet=True)
ended = time.perf_counter()
print("files", spent[0] + ended, ended - began)
"""

#: the paper's case stage by stage, in pieces that end where energies are due; there is room for all pairs it will ever list
_PROFILE = """
import sys
from benchmarks.timed_step import timed
from dilatedem.case.load import load
from dilatedem.run.simulation import Simulation
from dilatedem.state.pairs import grown
from dilatedem.run.ending import total_steps
case = load(sys.argv[1], [])
simulation = Simulation.of_case(case)
simulation.state.pairs = grown(simulation.state.pairs, 4 * len(simulation.state.pairs.a))
simulation.make_room()
simulation.evaluate()
steps = total_steps(case, simulation.dt)
found, _ = timed(simulation, steps, calls=round(case.time.duration / case.output.energy_interval))
print(*(f"{stage} {steps * value * 1e-6}" for stage, value in found.items()))
"""

#: a large field in memory and a few steps of it
_LARGE = """
import sys, time
from benchmarks.scenes import settled, sized
simulation = sized(settled("packed", "liu2015"), int(sys.argv[1]))
simulation.advance(5)
began = time.perf_counter()
simulation.advance(10)
print("large", simulation.model.floating, (time.perf_counter() - began) / 10)
"""


#: steps of a packed field of 2000 floes
_BUSY = """
import sys, time
from benchmarks.scenes import packed_field
from dilatedem.jit import start_threads
threads = int(sys.argv[1])
start_threads(threads)
simulation = packed_field(2000, "liu2015", threads=threads)
began = time.perf_counter()
simulation.advance(1000)
print("busy", (time.perf_counter() - began) / 1000)
"""

#: has a process tell its peak memory, kB, at its end. What `wait4` says of a child begins with the memory of its parent.
_PEAK = """
import atexit
def tell():
    with open("/proc/self/status") as status:
        print("peak_kB", status.read().split("VmHWM:")[1].split()[0])
atexit.register(tell)
"""
_MODULE = "import runpy\nrunpy.run_module({!r}, run_name='__main__', alter_sys=True)"


def _telling(arguments: list[str]) -> list[str]:
    """The same process, telling its peak memory where the system knows it."""
    if not Path("/proc/self/status").exists():
        return arguments
    kind, what, *rest = arguments
    return ["-c", _PEAK + (what if kind == "-c" else _MODULE.format(what)), *rest]


def _run(arguments: list[str], environment: dict[str, str] | None = None) -> tuple[str, float, float]:
    """Standard output, wall time [s] and peak memory [GB] of a Python process. Raises RuntimeError where it fails."""
    began = time.perf_counter()
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as complaints:
        process = subprocess.Popen([sys.executable, *_telling(arguments)], stdout=out, stderr=complaints, cwd=ROOT, env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        spent = time.perf_counter() - began
        out.seek(0)
        complaints.seek(0)
        if process.returncode != 0:
            raise RuntimeError(f"{' '.join(arguments)[-200:]}: exit code {process.returncode}\n{complaints.read()[-2000:]}")
        printed, told, peak = out.read().partition("peak_kB")
        unit = 1.0 if sys.platform == "darwin" else 1024.0
        return printed, spent, (float(peak) if told else usage.ru_maxrss) * unit / 1e9


def _figure(name: str, value: float, unit: str, note: str) -> dict:
    return {"name": name, "value": value, "unit": unit, "note": note} | describe(1)


def start() -> list[dict]:
    """Time from the start of the process to the end of the paper case's first step: without compiled code, then with."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": str(Path(folder) / "cache")}
        times = []
        for turn in range(4):
            out = str(Path(folder) / f"run{turn}")
            began = time.time()
            printed, _, _ = _run(["-c", _FIRST_STEP, "run", str(PAPER_CASE), "--out", out, "--quiet"], environment)
            times.append(float(printed.split()[-1]) - began)
    return [
        _figure("start_cold_s", times[0], "s", "cases/pile.toml to its first step, empty cache"),
        _figure("start_warm_s", min(times[1:]), "s", "the same with compiled kernels, best of three"),
    ]


def files() -> list[dict]:
    """Share of a run's wall time that goes into its files and the watch over its step, at the default intervals, best of three."""
    found = []
    for _ in range(3):
        with tempfile.TemporaryDirectory() as folder:
            printed, _, _ = _run(["-c", _FILES, str(PAPER_CASE), str(FILES_DURATION), str(Path(folder) / "run")])
        spent, whole = (float(word) for word in printed.split()[-2:])
        found.append((spent / whole, spent, whole))
    share, spent, whole = min(found)
    note = (
        f"{spent:.3g} of {whole:.2f} s for {FILES_DURATION:g} s of cases/pile.toml: all but the stepping, so tables, energies, "
        "snapshots, checkpoints, copies for the check of the step"
    )
    return [_figure("files_percent", 100.0 * share, "%", note)]


def memory() -> list[dict]:
    """Peak memory of the packed scene with a hundred thousand floes, in a process that only steps."""
    printed, _, peak = _run(["-c", _LARGE, str(LARGE)])
    floes = int(printed.split()[-2])
    return [_figure("memory_gb", peak, "GB", f"peak of a process that steps {floes} packed floes")]


def generate() -> list[dict]:
    """Wall time and peak memory of `dilatedem generate` for a hundred thousand floes of 2.8 m."""
    side = round((LARGE * 2.8**2 / 0.64) ** 0.5, 1)
    sets = [f"domain.size=[{side},{side}]", f"field.floe_count={LARGE}"]
    with tempfile.TemporaryDirectory() as folder:
        overrides = [word for text in sets for word in ("--set", text)]
        arguments = ["-m", "dilatedem.cli", "generate", str(PAPER_CASE), "--out", str(Path(folder) / "field"), *overrides]
        _, spent, peak = _run(arguments)
    return [
        _figure("generate_s", spent, "s", f"dilatedem generate with {LARGE} floes, field.vtu and field.png included"),
        _figure("generate_gb", peak, "GB", "peak of the same"),
    ]


def paper() -> list[dict]:
    """Wall time of the whole paper case as a user runs it, compiled kernels at hand; time of its steps by stage."""
    _run(["-c", "from dilatedem.run.loop import compile_kernels; compile_kernels()"])
    with tempfile.TemporaryDirectory() as folder:
        _, spent, _ = _run(["-m", "dilatedem.cli", "run", str(PAPER_CASE), "--out", str(Path(folder) / "run"), "--quiet"])
    words = _run(["-c", _PROFILE, str(PAPER_CASE)])[0].split()
    return [
        _figure("paper_s", spent, "s", "dilatedem run cases/pile.toml, whole, one thread, compiled kernels at hand"),
        *(
            _figure(PAPER_STAGE.format(stage), float(value), "s", f"of the steps of cases/pile.toml: {stage}")
            for stage, value in zip(words[::2], words[1::2], strict=True)
        ),
    ]


def sweep() -> list[dict]:
    """Wall time of a sweep of eight seeds of the paper's case, 10 s each, two at a time, compiled kernels at hand."""
    _run(["-c", "from dilatedem.run.loop import compile_kernels; compile_kernels()"])
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--seeds", "8", "--jobs", "2", "--set", "time.duration=10", "--out", str(Path(folder) / "sweep")]
        _, spent, _ = _run(["-m", "dilatedem.cli", "sweep", str(PAPER_CASE), *arguments])
    return [_figure("sweep_s", spent, "s", "dilatedem sweep cases/pile.toml --seeds 8 --jobs 2 --set time.duration=10")]


def busy() -> list[dict]:
    """Speed of two threads over that of one while other processes use all cores: 2000 packed floes."""
    idlers = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(os.cpu_count() or 1)]
    try:
        one, two = (min(float(_run(["-c", _BUSY, str(threads)])[0].split()[-1]) for _ in range(3)) for threads in (1, 2))
    finally:
        for idler in idlers:
            idler.kill()
            idler.wait()
    note = f"2000 packed floes, a step {1e3 * one:.3g} ms by one thread, {1e3 * two:.3g} ms by two, while others use all cores"
    return [_figure("busy_two_threads", one / two, "x", note)]


OTHERS = {
    "start": start, "files": files, "memory": memory, "generate": generate, "paper": paper, "sweep": sweep, "busy": busy,
}  # fmt: skip
