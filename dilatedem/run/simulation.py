"""The composition root: a case becomes arrays, arrays are advanced, observers write. No physics of its own."""

import math
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dilatedem import __version__
from dilatedem.case import write
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, Interrupted, SimulationStopped
from dilatedem.jit import Alone, Team, is_cached, start_threads
from dilatedem.motion.timestep import critical_step
from dilatedem.output import checkpoint, folder
from dilatedem.output.progress import Progress
from dilatedem.run.error_check import Watch
from dilatedem.run.interruption import Interruption
from dilatedem.run.output import RunOutput, Totals
from dilatedem.run.pace import free_span, time_step, total_steps
from dilatedem.scene.place import (
    Scene,
    build_model,
    compose,
    initial_bodies,
    load_map_geometry,
    ordered_structures,
)
from dilatedem.state.bodies import Bodies
from dilatedem.state.clock import Clock, Status, clock_at_start
from dilatedem.state.ledger import Ledger, empty_ledger, energies
from dilatedem.state.loads import Loads, Windows, empty_loads, no_windows
from dilatedem.state.model import Model
from dilatedem.state.pairs import Pairs, empty_pairs, grown, in_use, unpacked
from dilatedem.state.storage import Cells, Tally, Workspace, empty_tally, make_cells, make_workspace
from dilatedem.step.advance import advance

#: steps between two looks at the keyboard and the progress bar, where no output is due earlier
LONGEST_CHUNK = 2000
#: room for pairs at the start, per body; it grows where it is not enough
PAIRS_PER_BODY = 8


@dataclass
class State:
    """Everything that varies; a checkpoint holds all of it."""

    bodies: Bodies
    pairs: Pairs
    ledger: Ledger
    loads: Loads
    clock: Clock
    totals: Totals
    watch: Watch | None = None  # of the highest load, where `time.error_check` asks for it

    def groups(self) -> dict:
        own = {name: getattr(self, name) for name in ("bodies", "ledger", "loads", "clock")}
        return own | {"pairs": in_use(self.pairs)} | (self.watch.groups() if self.watch else {})

    def copies(self) -> dict:
        """The same groups as they are now, while the state goes on to change."""
        kept = self.watch.groups() if self.watch else {}
        return {name: kept.get(name) or type(group)(*map(np.copy, group)) for name, group in self.groups().items()}


@dataclass
class Simulation:
    """One case, ready to be advanced; the compiled kernels see only its arrays."""

    case: Case
    scene: Scene
    model: Model
    state: State
    dt: float
    critical: float
    span: int = 1  # steps that bodies which nothing can touch take in one
    threads: int = 1
    spare: Pairs = field(init=False)
    cells: Cells = field(init=False)
    workspace: Workspace = field(init=False)
    tally: Tally = field(init=False)
    windows: Windows = field(init=False)

    def __post_init__(self):
        self.cells, self.tally = make_cells(self.model.floating), empty_tally()
        self.windows = no_windows(len(self.state.loads.step_contacts))
        self._make_room()

    @classmethod
    def of_case(cls, case: Case, *, threads: int = 1) -> "Simulation":
        """A case at t = 0, its loads not evaluated yet. Raises CaseError for what only building it can tell."""
        scene = compose(case)
        if not scene.count:
            raise CaseError("the case has no bodies: no floe is clear of the structures, and there is no [[body]]")
        beyond = [n for n in (case.output.track if case.output.track != "all" else []) if n >= scene.count]
        if beyond:
            raise CaseError(f"output.track: there is no body {beyond[0]}; they are numbered from 0 to {scene.count - 1}")
        model = build_model(case, scene)
        bodies = initial_bodies(case, scene, model)
        critical = critical_step(model, bodies)
        dt = time_step(case, critical)
        span = free_span(case, dt)
        state = State(
            bodies, empty_pairs(PAIRS_PER_BODY * scene.count + 64), empty_ledger(),
            empty_loads(*load_map_geometry(case, scene)), clock_at_start(), Totals(),
            Watch(dt, span) if case.time.error_check else None,
        )  # fmt: skip
        return cls(case, scene, model, state, dt, critical, span, threads)

    @property
    def time_s(self) -> float:
        return int(self.state.clock.step[0]) * self.dt

    @property
    def contacts(self) -> int:
        pairs = self.state.pairs
        return int(np.count_nonzero(pairs.overlap[: pairs.count[0]] > 0.0))

    def evaluate(self) -> Status:
        """Loads at t = 0, before the first step: a step of no length, not counted."""
        status = self.advance(1, dt=0.0)
        self.state.clock.step[0] = 0
        self.state.loads.steps[0] = self.windows.count[0] = 0
        return status

    def advance(self, steps: int, *, dt: float | None = None) -> Status:
        """Up to `steps` steps; fewer where something is wrong (see `state.clock`)."""
        goal = int(self.state.clock.step[0]) + steps
        while True:
            status = self._call(advance, self.dt if dt is None else dt, self.span, goal - int(self.state.clock.step[0]))
            if status != Status.PAIRS_FULL:
                return status
            self.state.pairs = grown(self.state.pairs, 2 * len(self.state.pairs.a))
            self._make_room()

    def energies(self) -> dict[str, float]:
        """The ledger as `advance` left it, in J: the columns of energy.csv (without time and residual)."""
        structures = 0.0  # they do not move
        return energies(self.state.ledger, float(self.state.bodies.work_drag.sum()), structures)

    def assembled_step_ratio(self) -> float:
        """dt over the critical step of the contacts that were open when `advance` came back (an upper bound)."""
        damping = self.model.contact.damping
        return self.dt * float(self.state.clock.frequency[0]) / (2.0 * (math.sqrt(1.0 + damping**2) - damping))

    def is_compiled(self) -> bool:
        """Whether machine code of `advance` for this simulation lies on disk."""
        return is_cached(advance, *self._arguments(), self.dt, self.span, 1)

    def _call(self, kernel, *more) -> Status:
        return Status(kernel(*self._arguments(), *more))

    def _arguments(self) -> tuple:
        team = Alone() if self.threads == 1 else Team(self.threads)
        state = self.state
        return (
            team, self.model, state.bodies, state.pairs, self.spare, self.cells, self.workspace, self.tally, state.ledger,
            state.loads, self.windows, state.clock,
        )  # fmt: skip

    def _make_room(self) -> None:
        capacity = len(self.state.pairs.a)
        self.spare = empty_pairs(capacity)
        self.workspace = make_workspace(self.model.shapes, self.model.hulls, capacity, self.threads)


def check(case: Case) -> dict:
    """What follows from a case: floes, mass, time step, steps, expected size of the output."""
    simulation = Simulation.of_case(case)
    steps, output = total_steps(case, simulation.dt), case.output
    solids, floating = simulation.model.solids, simulation.model.floating
    scene = simulation.scene
    areas = scene.plan_area[scene.explicit :]
    rows = case.time.duration / output.force_interval * len(scene.structures)
    tracked = floating if output.track == "all" else len(output.track)
    snapshots = case.time.duration / output.snapshot_interval + 1 if output.snapshot_interval else 0
    size = 150 * rows + 130 * tracked * case.time.duration / output.track_interval + snapshots * (3e3 + 350 * floating)
    facts = {
        "floes": len(areas),
        "explicit bodies": scene.explicit,
        "floes left out at structures": scene.field.left_out,
        "structures": len(scene.structures),
        "mass, t": solids.mass[:floating].sum() / 1e3,
        "critical step, s": simulation.critical,
        "step, s": simulation.dt,
        "step / critical step": simulation.dt / simulation.critical,
        "steps": steps,
        "output, MB, about": size / 1e6,
    }
    if len(areas):
        facts |= {"concentration": scene.field.concentration, "floe size, m": float(np.sqrt(areas.mean()))}
    return facts


def compile_kernels(threads: int = 1, model: str = "liu2015") -> None:
    """Compile what a run with a contact model needs, or load it from the cache."""
    case = Case.model_validate({
        "field": {"source": "bodies"}, "body": [{"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.1}],
        "contact": {"model": model},
    })  # fmt: skip
    simulation = Simulation.of_case(case, threads=threads)
    simulation.evaluate()
    simulation.advance(1)


def run(case: Case, out: Path, *, threads: int = 1, resume: bool = False, overwrite: bool = False, quiet: bool = False) -> Path:
    """Simulate a case into the run folder `out`; returns it.

    Raises CaseError (nothing written), SimulationStopped or Interrupted (state saved).
    """
    out = Path(out)
    if folder.holds_run(out) and not (resume or overwrite):
        raise CaseError(f"{out}: holds a run already; continue it with --resume, replace it with --overwrite, or choose --out")
    if resume and not folder.holds_run(out):
        raise CaseError(f"{out}: holds no run to resume; leave --resume away to start one")
    try:
        layer = start_threads(threads)
    except ValueError as fault:
        raise CaseError(f"--{fault}") from fault
    simulation = Simulation.of_case(case, threads=threads)
    saved = _load_checkpoint(out, case, simulation) if resume else None
    steps = total_steps(case, simulation.dt)
    with Progress(case.time.duration, quiet) as progress:
        progress.message(_headline(simulation, steps, layer))
        compile_s = _compile(simulation, progress)
        with (
            Interruption() as interruption,
            RunOutput(simulation, out, saved) if saved else RunOutput.fresh(simulation, out) as output,
        ):
            output.note_compiling(compile_s)
            if not saved:
                _stop_on_fault(simulation, output, simulation.evaluate())
                output.observe()
            _loop(simulation, output, steps, progress, interruption)
    return out


def _compile(simulation: Simulation, progress: Progress) -> float:
    """Have the kernels ready before any file is touched: Ctrl-C ends this at once, with nothing to save. Returns the time, s."""
    started = time.perf_counter()
    if not simulation.is_compiled():
        progress.message("compiling, once (about twenty seconds)")
    try:
        compile_kernels(simulation.threads, simulation.case.contact.model)
    except KeyboardInterrupt:
        raise Interrupted("interrupted while compiling; no file was touched") from None
    return time.perf_counter() - started


def _loop(simulation: Simulation, output: RunOutput, steps: int, progress: Progress, interruption: Interruption) -> None:
    """Advance from one due output to the next until the end, an interruption or a fault."""
    clock, longest = simulation.state.clock, -(-LONGEST_CHUNK // simulation.span) * simulation.span
    now = int(clock.step[0])
    progress.update(simulation.time_s, now, lambda: simulation.contacts)
    while now < steps:
        status = simulation.advance(min(output.next_due, steps, now + longest) - now)
        _stop_on_fault(simulation, output, status)
        now = int(clock.step[0])
        output.observe(last=now == steps)
        progress.update(simulation.time_s, now, lambda: simulation.contacts)
        if interruption.asked and now < steps:
            output.interrupt()
            raise Interrupted(f"interrupted at t = {simulation.time_s:.4f} s; the state is saved, --resume goes on from it")
    found = output.complete(lambda: interruption.asked)
    if found:
        progress.message(found)


def _stop_on_fault(simulation: Simulation, output: RunOutput, status: Status) -> None:
    if status != Status.DONE:
        sentence = _fault(simulation, status)
        output.stop(sentence)
        raise SimulationStopped(sentence)


def restored(case: Case, out: Path) -> Simulation:
    """A case in the state that its run folder holds. Raises CaseError as `run` does with `resume`."""
    simulation = Simulation.of_case(case)
    _load_checkpoint(Path(out), case, simulation)
    return simulation


def _load_checkpoint(out: Path, case: Case, simulation: Simulation) -> dict:
    """Restore the saved state into `simulation`; returns the checkpoint's meta."""
    kept = out / folder.CASE
    text = kept.read_text(encoding="utf-8") if kept.exists() else ""
    if text.partition("\n\n")[2] != write.dump(case):
        raise CaseError(f"{kept}: is not the case given; resume with the case that the run was started with")
    groups, meta = checkpoint.load(out / folder.CHECKPOINT)
    if meta["version"] != __version__:
        raise CaseError(f"{out / folder.CHECKPOINT}: was written by dilatedem {meta['version']}; resume with that version")
    if meta["dt"] != simulation.dt:
        steps = f"{meta['dt']:g} s, this program takes {simulation.dt:g} s"
        raise CaseError(f"{out / folder.CHECKPOINT}: has steps of {steps}; run anew with --overwrite")
    state, room = simulation.state, len(simulation.state.pairs.a)
    for name, current in state.groups().items():
        setattr(state, name, checkpoint.restore(type(current), groups[name], where=str(out / folder.CHECKPOINT)))
    state.pairs = unpacked(state.pairs, max(room, len(state.pairs.a)))
    state.totals = Totals(**meta["totals"])
    if state.watch:
        state.watch.restore(groups, meta["watch"], where=str(out / folder.CHECKPOINT))
    simulation._make_room()
    return meta


def _headline(simulation: Simulation, steps: int, layer: str) -> str:
    ratio = simulation.dt / simulation.critical
    return (
        f"{simulation.scene.count} bodies, {steps} steps of {simulation.dt:.3g} s = {ratio:.3g} of the critical step "
        f"({simulation.critical:.3g} s); {f'{simulation.threads} threads ({layer})' if layer else '1 thread'}"
    )


def _fault(simulation: Simulation, status: Status) -> str:
    """One sentence: which bodies, when, why, what to do."""
    clock = simulation.state.clock
    names = [_body_name(simulation, int(i)) for i in clock.culprit if i >= 0]
    measure = float(clock.measure[0])
    if status == Status.TOO_DEEP:
        cause = f"{names[0]} and {names[1]} overlap by {measure:.3g} m, more than their rounded edges can mean"
    else:
        moved = f"{measure:.3g} m" if math.isfinite(measure) else "without bound"
        cause = f"{names[0]} moved {moved} in one step"
    return f"stopped at t = {simulation.time_s:.6g} s: {cause}; the state is saved; try a smaller time.step or check the case"


def _body_name(simulation: Simulation, body: int) -> str:
    floating = simulation.model.floating
    if body >= floating:
        return f'structure "{ordered_structures(simulation.scene)[body - floating].name}"'
    x, y = simulation.state.bodies.position[body, :2]
    return f"body {body} at ({x:.2f}, {y:.2f})"
