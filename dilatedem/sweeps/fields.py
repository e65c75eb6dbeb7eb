"""Ice fields of a sweep, made before anything is written: one that cannot be used is told then, not hours later by its run."""

import json
import time
from collections.abc import Callable, Sequence

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.output import folder
from dilatedem.run.simulation import Simulation
from dilatedem.scene.place import Scene
from dilatedem.sweeps.plan import Job

#: s of wall time for which fields are made, unless all of them are asked for
LOOK_S = 5.0
#: floes of all scenes together that are kept for the runs, which are copies of this process: some 100 MB
MOST_KEPT = 20_000
#: sections of a case that no field depends on
INDIFFERENT = {"title", "contact", "time", "output"}


#: scenes that were made to try their fields, by the case
_KEPT: dict[str, Scene] = {}


def require_fields(todo: Sequence[Job], *, every: bool = False, clock: Callable[[], float] = time.monotonic) -> str:
    """Make the fields of the cases that have yet to begin, for LOOK_S, or `every` one; each that occurs once only.

    The first seeds of all settings come first. Raises CaseError for the first that cannot be used, with the folder of its case.
    Returns a note on how many were left out, empty where none was.
    """
    begun = [job for job in todo if job.status == "waiting" and not (job.folder / folder.CHECKPOINT).exists()]
    until, made = clock() + LOOK_S, set()
    for count, job in enumerate(sorted(begun, key=lambda job: job.case.field.seed)):
        if not every and clock() > until:
            tried = f"fields of {count} of {len(begun)} cases were tried, in {LOOK_S:g} s"
            return f"{tried}; --check-all tries all before the first run"
        if (field := _field_of(job.case)) not in made:
            made.add(field)
            _require_field(job)
    return ""


def _require_field(job: Job) -> None:
    try:
        simulation = Simulation.of_case(job.case)
        simulation.require_apart()
    except CaseError as error:
        raise CaseError(f"{job.folder.name}: {error}") from None
    if sum(scene.count for scene in _KEPT.values()) + simulation.scene.count <= MOST_KEPT:
        _KEPT[_named(job.case)] = simulation.scene


def scene_at_hand(case: Case) -> Scene | None:
    """The scene of a case, where this process, or the one that it is a copy of, made it to try its field."""
    return _KEPT.get(_named(case)) if _KEPT else None


def _named(case: Case) -> str:
    """A case in words."""
    return json.dumps(case.model_dump(), default=str)


def _field_of(case: Case) -> str:
    """What of a case its ice field depends on, and perhaps more."""
    return json.dumps(case.model_dump(exclude=INDIFFERENT), default=str)
