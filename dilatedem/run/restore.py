"""A simulation in the state that its run folder holds."""

from pathlib import Path

import numpy as np

from dilatedem import __version__
from dilatedem.case import write
from dilatedem.case.differences import differences
from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.files.atomic import write_bytes
from dilatedem.output import checkpoint, folder
from dilatedem.output.tables import verified
from dilatedem.run.ending import total_steps
from dilatedem.run.observers import OBSERVERS
from dilatedem.run.simulation import REMODELLED, Simulation
from dilatedem.state.bodies import joined_rows
from dilatedem.state.pairs import unpacked

#: keys that are named where two cases differ, at most
MOST_NAMED = 5


def restored(case: Case, out: Path) -> Simulation:
    """A case in the state that its run folder holds. Raises CaseError as `load_checkpoint`."""
    simulation = Simulation.of_case(case)
    load_checkpoint(Path(out), case, simulation)
    return simulation


def load_checkpoint(out: Path, case: Case, simulation: Simulation) -> dict:
    """Restore the state saved in the run folder `out` into `simulation`; returns the checkpoint's meta.

    A case that differs in when it ends alone goes on from a state of before that made a difference. Raises CaseError where there
    is none, where it is damaged or belongs to another case, version or step, or where the tables are not those that it was taken
    after.
    """
    file, (groups, meta) = out / folder.CHECKPOINT, _saved(out, case, simulation.dt)
    for kind in OBSERVERS:
        table = meta["observers"].get(kind.name, {})
        if "digest" in table:
            verified(out / kind.file, table["offset"], table["digest"])
    state, model, room = simulation.state, simulation.model, len(simulation.state.pairs.a)
    for name, current in state.groups().items():
        setattr(state, name, checkpoint.restore(type(current), groups[name], where=str(file)))
    state.pairs = unpacked(state.pairs, max(room, len(state.pairs.a)))
    if state.watch:
        state.watch.restore(groups, meta["watch"], type(state.excursions), where=str(file))
    simulation.make_room()
    if "shapes" in groups:  # bodies have come or gone since the start
        arrays = {name: checkpoint.restore(type(getattr(model, name)), groups[name], where=str(file)) for name in REMODELLED}
        own, structures = model.structure_of[: model.floating], model.structure_of[model.floating :]
        since, ids = np.full(len(state.ids.body), -1), state.ids.body  # those that have come since are part of no structure
        since[ids < len(own)] = own[ids[ids < len(own)]]
        structure_of = np.concatenate([since, structures])
        joined = joined_rows(arrays["solids"].floe)
        simulation.adopt(model._replace(floating=len(state.ids.body), structure_of=structure_of, joined=joined, **arrays))
    return meta


def _saved(out: Path, case: Case, dt: float) -> tuple[dict, dict]:
    """Groups and meta of the state from which a case with steps of `dt` [s] goes on in the run folder `out`."""
    kept, file = out / folder.CASE, out / folder.CHECKPOINT
    ends_alike = require_same(kept, case)
    groups, meta = checkpoint.load(file)
    if meta["case"] != write.digest(case.endless):
        raise CaseError(f"{file}: belongs to another case than {kept}; start anew with --overwrite")
    if meta["version"] != __version__:
        raise CaseError(f"{file}: was written by dilatedem {meta['version']}; resume with that version")
    if meta["dt"] != dt:
        steps = f"{meta['dt']:g} s, this program takes {dt:g} s"
        raise CaseError(f"{file}: has steps of {steps}; run anew with --overwrite")
    if (came := int(groups["clock"]["step"][0])) > total_steps(case, dt):
        begun = f"the run has come to {came * dt:g} s already"
        raise CaseError(f"time.duration = {case.time.duration:g}: {begun}; ask for more, or run anew with --overwrite")
    if meta.get("over") and not ends_alike:
        write_bytes(file, checkpoint.image_and_seal(out / folder.BEFORE_END), durable=True)
        groups, meta = checkpoint.load(file)
    return groups, meta


def require_same(kept: Path, case: Case) -> bool:
    """Whether a case ends as that of a run folder, whose file is `kept`; it may be longer, or have fewer conditions that end it.

    Raises CaseError that names the keys in which they differ else.
    """
    if _text(kept).partition("\n\n")[2] == write.dump(case):
        return True
    try:
        differing = _keys_apart(load(kept), case)
    except CaseError:
        raise CaseError(f"{kept}: is not the case given; resume with the case that the run was started with") from None
    if differing:
        raise CaseError(
            f"{kept}: is not the case given: it has another {_named(differing)}; resume with the case that "
            "the run was started with: only time.duration may be another, and conditions of time.until be left out"
        )
    return False


def require_same_run(out: Path, case: Case) -> None:
    """Raises CaseError unless the run that the folder `out` holds is one of this case, so that to run it again is to go on."""
    kept, way_on = out / folder.CASE, "replace it with --overwrite, or choose another --out"
    if _text(kept).partition("\n\n")[2] == write.dump(case):
        return
    try:
        differing = _keys_apart(load(kept), case)
    except CaseError:
        raise CaseError(f"{out}: holds a run already, of a case that cannot be read; {way_on}") from None
    if differing:
        raise CaseError(f"{out}: holds a run already, of a case with another {_named(differing)}; {way_on}")


def _text(kept: Path) -> str:
    return kept.read_text(encoding="utf-8", errors="replace") if kept.exists() else ""


def _keys_apart(before: Case, case: Case) -> list[str]:
    """Dotted keys at which a case differs from that of before, but for those in which it may."""
    until, asked = before.time.until.model_dump(), case.time.until.model_dump()
    added = [f"time.until.{name}" for name, value in asked.items() if value and value != until[name]]
    return [*differences(before.endless.model_dump(), case.endless.model_dump()), *added]


def _named(keys: list[str]) -> str:
    more = f" and {len(keys) - MOST_NAMED} more" if len(keys) > MOST_NAMED else ""
    return f"{', '.join(keys[:MOST_NAMED])}{more}"
