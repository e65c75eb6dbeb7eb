"""A simulation: a case as arrays, and the kernels that advance them. No physics of its own, and no files."""

import math
import time
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dilatedem.case.load import case_from
from dilatedem.case.schema import Case
from dilatedem.contact.laws import law_of
from dilatedem.errors import CaseError, SimulationStopped
from dilatedem.events.event import Event
from dilatedem.events.kinds import events_of
from dilatedem.events.relaxation import Relaxed, begun
from dilatedem.jit import Alone, NoTimer, Team, Timer, is_cached, share_among, start_threads
from dilatedem.motion.strides import Pace
from dilatedem.motion.timestep import critical_step, usual_speed
from dilatedem.run.advice import advice
from dilatedem.run.crew import Crew
from dilatedem.run.error_check import Watch
from dilatedem.run.faults import fault
from dilatedem.run.hits import hit_log, hits_at_start
from dilatedem.run.pace import STRIDE_PHASE, free_span, time_step
from dilatedem.run.views import Floes, Structures
from dilatedem.scene.arrays import build_model, initial_bodies, initial_excursions
from dilatedem.scene.entering import Entering
from dilatedem.scene.inflow import strips_at_start
from dilatedem.scene.overlaps import require_apart
from dilatedem.scene.place import Scene, compose
from dilatedem.state.bodies import Bodies, Ids
from dilatedem.state.clock import NEVER, Clock, Status, clock_at_start
from dilatedem.state.hits import HitLog, Hits
from dilatedem.state.inflow import Inflow, inflow_at_start
from dilatedem.state.ledger import Ledger, empty_ledger, energies
from dilatedem.state.loads import Loads, Windows, empty_loads, no_windows
from dilatedem.state.modal import ModalSolids, bending_room
from dilatedem.state.model import Model
from dilatedem.state.pairs import Pairs, empty_pairs, grown, in_use
from dilatedem.state.setting import CRUSHING_SETTINGS
from dilatedem.state.storage import Cells, Tally, Workspace, empty_tally, make_cells, make_workspace
from dilatedem.state.supports import Excursions, support_energies
from dilatedem.step.advance import advance
from dilatedem.water.loads import WORKS, wet_columns, works_of

#: room for pairs at the start, per body; it grows where it is not enough
PAIRS_PER_BODY = 8
#: of the model, what an event changes
REMODELLED = ("shapes", "hulls", "solids")
#: steps by which a time may be missed, as sums of decimal numbers are
ROUND_OFF = 1e-6


@dataclass
class State:
    """Everything that varies; a checkpoint holds all of it."""

    ids: Ids
    bodies: Bodies
    pairs: Pairs
    ledger: Ledger
    loads: Loads
    hits: Hits
    clock: Clock
    excursions: Excursions
    watch: Watch | None = None  # of the highest load, where `time.error_check` asks for it
    inflow: Inflow | None = None  # where ice enters
    relaxed: Relaxed | None = None  # where it comes to rest

    @property
    def _optional(self) -> list[str]:
        return [name for name in ("inflow", "relaxed") if getattr(self, name)]

    def groups(self) -> dict:
        """All arrays of the state, by name."""
        names = ("ids", "bodies", "ledger", "loads", "hits", "clock", "excursions", *self._optional)
        own = {name: getattr(self, name) for name in names}
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
    speed: float = 0.0  # m/s, how fast ice is taken to go
    strides: bool = True  # whether busy bodies may take several steps in one, too
    remodelled: bool = False  # whether bodies have come or gone
    timer: NoTimer | Timer = NoTimer()  # a `Timer` for a step that tells how long its stages take
    entering: Entering | None = field(init=False)  # the ice that enters, if any does
    events: list[Event] = field(init=False)  # that can happen
    spare: Pairs = field(init=False)
    cells: Cells = field(init=False)
    workspace: Workspace = field(init=False)
    tally: Tally = field(init=False)
    windows: Windows = field(init=False)
    log: HitLog = field(init=False)
    crew: Crew = field(init=False)  # of its threads, those that work

    def __post_init__(self):
        self.entering = Entering(self.case, self.scene) if self.scene.stream else None
        self.events, self.crew = events_of(self), Crew(self.threads)
        self.cells, self.tally = make_cells(self.model.floating), empty_tally()
        self.windows, self.log = no_windows(len(self.state.loads.step_contacts)), hit_log(self.case, self.model, self.dt)
        self.make_room()

    @classmethod
    def of_case(cls, case: Case, *, threads: int = 1, scene: Scene | None = None) -> "Simulation":
        """A case at t = 0, of its scene where that was made before. Raises CaseError for what only building it can tell."""
        scene = scene or compose(case)
        if not scene.count:
            raise CaseError("the case has no bodies: no floe is clear of the structures, and there is no [[body]]")
        beyond = [n for n in (case.output.track if case.output.track != "all" else []) if n >= scene.count]
        if beyond and not scene.stream:
            raise CaseError(f"output.track: there is no body {beyond[0]}; they are numbered from 0 to {scene.count - 1}")
        model = build_model(case, scene)
        bodies = initial_bodies(case, scene, model)
        critical = critical_step(model, bodies)
        dt = time_step(case, critical)
        span = 1 if case.time.relaxes else free_span(case, dt)
        loads = empty_loads(len(scene.records), int(model.charts.map.max(initial=-1)) + 1)
        watch = Watch(dt, span, len(scene.structures)) if case.time.error_check else None
        inflow = inflow_at_start(strips_at_start(case, scene.stream).stop) if scene.stream else None
        state = State(
            Ids(np.arange(scene.count)), bodies, empty_pairs(PAIRS_PER_BODY * scene.count + 64), empty_ledger(len(WORKS)),
            loads, hits_at_start(case, dt), clock_at_start(), initial_excursions(scene, model.supports), watch, inflow,
            begun() if case.time.relaxes else None,
        )  # fmt: skip
        return cls(
            case, scene, model, state, dt, critical, span, threads, speed=usual_speed(model, bodies), strides=not case.time.relaxes
        )

    @classmethod
    def from_case(cls, case, *, threads: int = 1, **overrides) -> "Simulation":
        """A case at t = 0: the path of a case file, a dictionary laid out like one, or a `Case`.

        overrides: values by dotted key, `**{"water.velocity": [0.5, 0.0]}`, or tables, `water={"velocity": [0.5, 0.0]}`.
        Raises CaseError for what is wrong with it.
        """
        try:
            start_threads(threads)
        except ValueError as error:
            raise CaseError(str(error)) from error
        return cls.of_case(case_from(case, overrides), threads=threads)

    def require_apart(self) -> None:
        """Raises CaseError that names the bodies that stand in each other, in structures or in walls: no run begins like that.

        For a simulation at t = 0. In Python one may look into what the laws make of it all the same.
        """
        require_apart(self.scene, self.model, self.state.bodies)

    def advice(self) -> list[str]:
        """What of the case is hardly meant, a sentence each; for a simulation at t = 0."""
        return advice(self.case, self.scene, self.model, self.state.bodies, share=self.dt / self.critical)

    def step(self, count: int = 1) -> None:
        """Go on by so many time steps of `dt`. Raises SimulationStopped where it cannot."""
        goal = int(self.state.clock.step[0]) + count
        while (now := int(self.state.clock.step[0])) < goal:
            status = self.advance(min(goal, self.next_event(now)) - now)
            if status != Status.DONE:
                raise SimulationStopped(fault(self, status))
            self.let_happen()

    def run(self, until: float | None = None) -> None:
        """Go on to the first step at or after the time `until` [s], the case's duration unless given; earlier times change nothing.

        Raises SimulationStopped where it cannot.
        """
        until = self.case.time.duration if until is None else until
        self.step(max(0, math.ceil((until - self.time) / self.dt - ROUND_OFF)))

    @cached_property
    def bent(self) -> dict:
        """The bodies that bend, each a `deformation.bent.Bent`, by number."""
        from dilatedem.scene.bending import bent_again  # it loads half of SciPy

        return bent_again(self.case, self.scene, self.model.solids)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.time_s

    @property
    def floes(self) -> Floes:
        """The floating bodies at this moment."""
        return Floes(self)

    @property
    def structures(self) -> Structures:
        """The structures by name, and the load on each in the last step."""
        return Structures(self)

    @property
    def energy(self) -> dict[str, float]:
        """The terms of the energy ledger at this moment [J], by the names that energy.csv has for them."""
        return self.energies()

    @property
    def time_s(self) -> float:
        return float(self.state.clock.time[0])

    @property
    def contacts(self) -> int:
        pairs = self.state.pairs
        return int(np.count_nonzero(pairs.overlap[: pairs.count[0]] > 0.0))

    def evaluate(self) -> Status:
        """Loads of this instant, for bodies as they stand: a step of no length, which no record counts.

        The first steps of a simulation call it; it is needed only where bodies were moved by hand.
        """
        clock, loads, windows = self.state.clock, self.state.loads, self.windows
        step, now, begun = int(clock.step[0]), float(clock.time[0]), bool(clock.begun[0])
        since = int(clock.since_step[0]), float(clock.since_time[0])
        steps, count = int(loads.steps[0]), int(windows.count[0])
        kept = {name: getattr(loads, name).copy() for name in ("window_extreme", "contact_sum", "mode_steps")}
        kept_sum = loads.window_sum.copy()
        clock.begun[0] = 1
        clock.since_step[0], clock.since_time[0] = step, now  # loads that depend on the time are those of now
        status = self._advance(1, dt=0.0)
        clock.step[0], clock.time[0], loads.steps[0], windows.count[0] = step, now, steps, count
        clock.since_step[0], clock.since_time[0] = since
        loads.window_sum[...] = kept_sum
        if begun:
            for name, values in kept.items():
                getattr(loads, name)[...] = values
        return status

    def advance(self, steps: int) -> Status:
        """Up to `steps` steps; fewer where something is wrong (see `state.clock`)."""
        if not self.state.clock.begun[0]:
            status = self.evaluate()
            if status != Status.DONE:
                return status
        began = time.perf_counter()
        status = self._advance(steps, dt=self.dt)
        self.crew.took(steps, time.perf_counter() - began)
        return status

    def _advance(self, steps: int, *, dt: float) -> Status:
        clock = self.state.clock
        clock.dt[0], goal = dt, int(clock.step[0]) + steps
        if self.threads > 1:
            share_among(self.crew.now)
        while True:
            status = Status(advance(*self._arguments(), self.pace, goal - int(clock.step[0])))
            if status != Status.PAIRS_FULL:
                return status
            self.state.pairs = grown(self.state.pairs, 2 * len(self.state.pairs.a))
            self.make_room()

    @property
    def pace(self) -> Pace:
        """How many steps bodies may take in one."""
        phase, long = STRIDE_PHASE / self.critical if self.strides else 0.0, law_of(self.model.contact).LONG_STRIDE
        return Pace(self.span, phase, self.speed, long)

    def energies(self) -> dict[str, float]:
        """The ledger as `advance` left it, in J: the columns of energy.csv (without time and residual)."""
        columns = {name: WORKS.index(name) for name in works_of(self.model.loads)}
        ledger, work = self.state.ledger, self.state.bodies.work
        done = {name: float(work[:, k].sum()) + float(ledger.departed_work[k]) for name, k in columns.items()}
        done |= support_energies(self.model.supports, self.state.excursions)
        if self.events:
            done["carried_out"] = float(ledger.carried_out[0])
        if self.state.inflow:
            done["carried_in"] = float(self.state.inflow.carried_in[0])
        if self.state.relaxed:
            done["loss_relax"] = float(self.state.relaxed.loss[0])
        absent = [] if isinstance(self.model.contact, CRUSHING_SETTINGS) else ["loss_crushing"]
        absent += [] if self.case.water.added_mass else ["kinetic_water"]
        if isinstance(self.model.solids, ModalSolids):
            done["loss_modal"] = float(self.state.bodies.mode_loss.sum())
        else:
            absent.append("modal")
        return energies(ledger, done, absent)

    def assembled_step_ratio(self) -> float:
        """dt over the critical step of the contacts that were open when `advance` came back (an upper bound)."""
        damping = self.model.contact.damping
        return self.dt * float(self.state.clock.frequency[0]) / (2.0 * (math.sqrt(1.0 + damping**2) - damping))

    def is_compiled(self) -> bool:
        """Whether machine code of `advance` for this simulation lies on disk."""
        return is_cached(advance, *self._arguments(), self.pace, 1)

    @cached_property
    def _runs_alone(self) -> bool:
        """Whether one of several threads can use the machine code for one, which starts no parallel loops: not worth compiling."""
        return is_cached(advance, *self._arguments(Alone()), self.pace, 1)

    def _arguments(self, team: Alone | Team | None = None) -> tuple:
        """Of `advance`; team: that of the threads that work now, unless given."""
        if team is None:
            alone = self.crew.now == 1 and (self.threads == 1 or self._runs_alone)
            team = Alone() if alone else Team(self.crew.now)
        state = self.state
        return (
            team, self.timer, self.model, state.ids, state.bodies, state.excursions, state.pairs, self.spare, self.cells,
            self.workspace, self.tally, state.ledger, state.loads, self.windows, state.hits, self.log, state.clock,
        )  # fmt: skip

    def next_event(self, step: int) -> int:
        """The first step after `step` at which an event may happen."""
        return min((event.schedule.next_due(step) for event in self.events), default=NEVER)

    def let_happen(self) -> bool:
        """Have the events happen that are due at the present step; returns whether bodies have come or gone."""
        step = int(self.state.clock.step[0])
        return any([event.happen(self) for event in self.events if event.schedule.is_due(step)])

    def adopt(self, model: Model) -> None:
        """Go on with other bodies; the state's rows are theirs already. From now on a checkpoint holds the model, too."""
        self.model, self.remodelled = model, True
        self.cells = make_cells(model.floating)
        self.make_room()

    def remodelled_groups(self) -> dict:
        """What of the model is no longer what the case makes of it, by name."""
        return {name: getattr(self.model, name) for name in REMODELLED} if self.remodelled else {}

    def make_room(self, capacity: int = 0) -> None:
        """Workspaces of the size that the list of pairs has, or of `capacity` pairs, where that is more."""
        if capacity > len(self.state.pairs.a):
            self.state.pairs = grown(self.state.pairs, capacity)
        capacity = len(self.state.pairs.a)
        self.spare = empty_pairs(capacity)
        columns = wet_columns(self.model.loads)
        self.workspace = make_workspace(self.model.shapes, self.model.hulls, capacity, self.threads, columns)
        if isinstance(self.model.solids, ModalSolids):
            bodies, modes = self.model.solids.mode_square.shape
            self.workspace = bending_room(self.workspace, self.threads, bodies, capacity, modes)
