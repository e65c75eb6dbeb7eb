"""What the program is meant to reach, beside what was measured: a bound that must hold, and one to aim for."""

from dataclasses import dataclass

from benchmarks.results import grouped


@dataclass(frozen=True)
class Target:
    """A figure with its two bounds; `at_least`: it has to be above them, otherwise below."""

    what: str
    value: float | None  # None: not measured
    must: float
    aim: float
    unit: str = ""
    at_least: bool = False

    def verdict(self) -> str:
        if self.value is None:
            return "not measured"
        for bound, word in ((self.aim, "**aim met**"), (self.must, "met")):
            if self.value >= bound if self.at_least else self.value <= bound:
                return word
        return "**missed**"


#: ms a step at 200 floes, one thread
STEP_MS = {"drift": (0.03, 0.01), "jam": (0.06, 0.02), "packed": (0.35, 0.15)}
#: figures of results_others.csv: words, bounds, unit
OTHERS = {
    "memory_gb": ("memory at 100 000 floes", 4.0, 2.0, "GB"),
    "generate_s": ("generate 100 000 floes", 60.0, 20.0, "s"),
    "start_warm_s": ("start to first step, compiled kernels at hand", 1.5, 0.7, "s"),
    "start_cold_s": ("start to first step, nothing compiled", 45.0, 20.0, "s"),
    "files_percent": ("share of wall time that files take", 5.0, 2.0, "%"),
    "paper_s": ("the paper's case, whole", 60.0, 10.0, "s"),
    "sweep_s": ("eight runs of 10 s, two at a time", 10.0, 5.0, "s"),
}


def _row(rows: list[dict], scene: str, model: str, size: int, threads: int, column: str) -> float | None:
    for row in rows:
        if (row["scene"], row["model"], row["size"], row["threads"]) == (scene, model, size, threads):
            return row[column]
    return None


def _per_contact(rows: list[dict], size: int) -> float | None:
    spent, contacts = (_row(rows, "field", "liu2015", size, 1, column) for column in ("ms_per_step", "contacts"))
    return _ratio(spent, contacts)


def _ratio(over: float | None, under: float | None) -> float | None:
    return over / under if over and under else None


def targets(rows: list[dict], others: list[dict]) -> list[Target]:
    """All targets. rows: of results.csv; others: of results_others.csv; either may be incomplete."""
    found = [
        Target(f"{scene}, 200 floes, a step", _row(rows, scene, "liu2015", 200, 1, "ms_per_step"), must, aim, "ms")
        for scene, (must, aim) in STEP_MS.items()
    ]
    for scene in ("drift", "packed"):
        large, small = (_row(rows, scene, "liu2015", size, 1, "us_per_floe_step") for size in (10_000, 200))
        found.append(Target(f"{scene}, cost per floe at 10 000 against 200", _ratio(large, small), 1.3, 1.1, "x"))
    largest = _row(rows, "packed", "liu2015", 100_000, 1, "ms_per_step")
    found.append(Target("packed, 100 000 floes, a step", largest, 300, 120, "ms"))
    for size in (2000, 10_000, 100_000):
        one, two = (_row(rows, "packed", "liu2015", size, threads, "ms_per_step") for threads in (1, 2))
        found.append(Target(f"packed, {grouped(size)} floes, two threads", _ratio(one, two), 1.7, 1.9, "x", at_least=True))
    large, small = (_per_contact(rows, size) for size in (10_000, 200))
    found.append(Target("field, cost per contact at 10 000 against 200", _ratio(large, small), 1.35, 1.15, "x"))
    for size, must, aim in ((2000, 1.6, 1.8), (10_000, 1.75, 1.9)):
        one, two = (_row(rows, "field", "liu2015", size, threads, "ms_per_step") for threads in (1, 2))
        found.append(Target(f"field, {grouped(size)} floes, two threads", _ratio(one, two), must, aim, "x", at_least=True))
    for scene in ("jam", "packed"):
        ours, paper = (_row(rows, scene, model, 200, 1, "ms_per_step") for model in ("consistent", "liu2015"))
        found.append(Target(f"{scene}, consistent against liu2015", _ratio(ours, paper), 1.5, 1.1, "x"))
    values = {other["name"]: other["value"] for other in others}
    busy = values.get("busy_two_threads")
    found.append(Target("two threads while others use both cores, against one then", busy, 0.8, 1.0, "x", at_least=True))
    found += [Target(words, values.get(name), must, aim, unit) for name, (words, must, aim, unit) in OTHERS.items()]
    return found
