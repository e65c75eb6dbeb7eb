"""One configuration timed: a scene, a size, a contact model and a number of threads."""

import time
from dataclasses import dataclass
from statistics import median

import numpy as np

from benchmarks.machine import describe
from benchmarks.scenes import ALL, MODELS, packed_field, rocking, settled, sized
from benchmarks.timed_step import timed
from benchmarks.yardstick import coal_step
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.state.pairs import unpacked
from dilatedem.step.stages import STAGES

#: steps before the first that is timed: friction springs that the copies of a scene start without
WARMING = 100
#: steps of the stretch that is timed, for sizes that allow it: the same stretch whatever the size, or costs could not be compared
STRETCH = 250
#: floe-steps of a stretch at most: larger sizes take fewer steps
LONGEST_WORK = 2_500_000
#: shortest time of one measurement, s; the stretch is repeated from its start until it is reached
SHORTEST = 0.3
#: floes up to which coal is asked: it answers pair by pair
YARDSTICK_FLOES = 500


@dataclass(frozen=True)
class Plan:
    """What to time. A machine has slow minutes, so everything is measured in several rounds, minutes apart, and the best counts."""

    scenes: tuple[str, ...] = ALL
    models: tuple[str, ...] = MODELS
    sizes: tuple[int, ...] = (200, 2000, 10_000, 100_000)
    threads: tuple[int, ...] = (1, 2)
    repeats: int = 2  # in a round
    rounds: int = 3

    def configurations(self):
        """Scene, model, size, threads, in an order that builds every scene once for each model; `rocking` has one size."""
        return [
            (scene, model, size, threads)
            for scene in self.scenes for model in self.models for size in self.sizes for threads in self.threads
            if scene != "rocking" or size == min(self.sizes)
        ]  # fmt: skip


class Replay:
    """A stretch of steps that can be run again and again from the same state."""

    def __init__(self, simulation: Simulation, steps: int):
        """Warm up, run through the stretch once, so that its pairs have room, and keep the state at its start."""
        self.simulation, self.steps = simulation, steps
        self._run(min(WARMING, steps))
        self._saved = {name: _copied(group) for name, group in simulation.state.groups().items()}
        self._run(steps)

    def rewind(self) -> None:
        """Back to the start of the stretch; one step more is taken, so that no memory is touched for the first time afterwards."""
        state = self.simulation.state
        for name, group in self._saved.items():
            if name == "pairs":
                state.pairs = unpacked(group, len(group.a))
                continue
            current = getattr(state, name)
            fits = all(now.shape == then.shape for now, then in zip(current, group, strict=True))
            if fits:
                for now, then in zip(current, group, strict=True):
                    now[...] = then
            else:
                setattr(state, name, _copied(group))
        self.simulation.make_room()  # a workspace may remember steps that are to come again
        self._run(1)

    def seconds(self) -> float:
        """Wall time of the stretch [s], the mean over as many runs as fill the shortest measurement."""
        spent, runs = 0.0, 0
        while spent < SHORTEST:
            self.rewind()
            began = time.perf_counter()
            self._run(self.steps)
            spent += time.perf_counter() - began
            runs += 1
        return spent / runs

    def stages(self, runs: int) -> tuple[dict[str, float], float]:
        """us a step for each stage in the fastest of so many runs, and awake pairs a step."""
        fastest = None
        for _ in range(runs):
            self.rewind()
            found = timed(self.simulation, self.steps)
            if fastest is None or sum(found[0].values()) < sum(fastest[0].values()):
                fastest = found
        return fastest

    def _run(self, steps: int) -> None:
        status = self.simulation.advance(steps)
        if status != Status.DONE:
            raise RuntimeError(f"the scene stopped: {status.name} at step {int(self.simulation.state.clock.step[0])}")


def _copied(group):
    return type(group)(*(np.copy(values) for values in group))


class Scenes:
    """Simulations of configurations; what takes long to make is kept."""

    def __init__(self):
        self._kept: dict[tuple, Simulation] = {}

    def ready(self, scene: str, model: str, size: int, threads: int) -> Simulation:
        """The simulation to time; nobody has advanced it."""
        if scene == "rocking":
            return rocking(model, threads=threads)
        if scene == "field":
            return packed_field(size, model, threads=threads)
        if (scene, model) not in self._kept:
            self._kept[scene, model] = settled(scene, model)
        return sized(self._kept[scene, model], size, threads=threads)


def measured(scene: str, model: str, size: int, threads: int, repeats: int, simulation: Simulation) -> tuple[dict, list[float]]:
    """A row of results.csv, and ms a step of every repeat, of a simulation of this configuration."""
    floes = simulation.model.floating
    steps = min(STRETCH, max(20, LONGEST_WORK // floes))
    replay = Replay(simulation, steps)
    row = {
        "scene": scene, "model": model, "size": size, "floes": floes, "threads": threads, "steps": steps, "dt_s": simulation.dt,
        "span": simulation.span,
    }  # fmt: skip
    times = [1e3 * replay.seconds() / steps for _ in range(repeats)]
    best = min(times)
    row |= {
        "ms_per_step": best,
        "ms_per_step_median": median(times),
        "us_per_floe_step": 1e3 * best / floes,
        "particle_steps_per_s": 1e3 * floes / best,
    }
    per_stage, awake = replay.stages(repeats)
    replay.rewind()
    row |= {
        "contacts": simulation.contacts, "listed_pairs": int(simulation.state.pairs.count[0]), "awake_pairs": float(awake),
    }  # fmt: skip
    row |= {f"{stage}_us": per_stage[stage] for stage in STAGES}
    asked = coal_step(simulation) if floes <= YARDSTICK_FLOES else None
    row |= asked or dict.fromkeys(("coal_ms", "coal_called_ms", "near_pairs", "coal_contacts"))
    return row | describe(threads), times


def rows_of(plan: Plan):
    """The rows of a plan as they are measured, in every round again: what is the best so far, and the median of all repeats."""
    scenes, best, all_times = Scenes(), {}, {}
    for _ in range(plan.rounds):
        for configuration in plan.configurations():
            describe(configuration[-1])  # makes the threads ready
            row, times = measured(*configuration, plan.repeats, scenes.ready(*configuration))
            all_times.setdefault(configuration, []).extend(times)
            best[configuration] = min(best.get(configuration, row), row, key=lambda found: found["ms_per_step"])
            yield best[configuration] | {"ms_per_step_median": median(all_times[configuration])}


def line(row: dict) -> str:
    """A row in one line, for the screen."""
    return (
        f"{row['scene']:7s}{row['model']:11s}{row['floes']:7d} floes {row['threads']} threads"
        f"{row['ms_per_step']:11.4f} ms a step  {row['us_per_floe_step']:7.4f} us a floe-step  {row['contacts']} contacts"
    )
