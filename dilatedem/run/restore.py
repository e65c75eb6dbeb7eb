"""A simulation in the state that its run folder holds."""

from pathlib import Path

import numpy as np

from dilatedem import __version__
from dilatedem.case import write
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.output import checkpoint, folder
from dilatedem.output.tables import verified
from dilatedem.run.observers import OBSERVERS
from dilatedem.run.simulation import REMODELLED, Simulation
from dilatedem.state.pairs import unpacked


def restored(case: Case, out: Path) -> Simulation:
    """A case in the state that its run folder holds. Raises CaseError as `load_checkpoint`."""
    simulation = Simulation.of_case(case)
    load_checkpoint(Path(out), case, simulation)
    return simulation


def load_checkpoint(out: Path, case: Case, simulation: Simulation) -> dict:
    """Restore the state saved in the run folder `out` into `simulation`; returns the checkpoint's meta.

    Raises CaseError where there is none, where it is damaged or belongs to another case, version or step, or where the tables are
    not those that it was taken after.
    """
    kept, file = out / folder.CASE, out / folder.CHECKPOINT
    text = kept.read_text(encoding="utf-8", errors="replace") if kept.exists() else ""
    if text.partition("\n\n")[2] != write.dump(case):
        raise CaseError(f"{kept}: is not the case given; resume with the case that the run was started with")
    groups, meta = checkpoint.load(file)
    if meta["case"] != write.digest(case):
        raise CaseError(f"{file}: belongs to another case than {kept}; start anew with --overwrite")
    if meta["version"] != __version__:
        raise CaseError(f"{file}: was written by dilatedem {meta['version']}; resume with that version")
    if meta["dt"] != simulation.dt:
        steps = f"{meta['dt']:g} s, this program takes {simulation.dt:g} s"
        raise CaseError(f"{file}: has steps of {steps}; run anew with --overwrite")
    for kind in OBSERVERS:
        table = meta["observers"].get(kind.name, {})
        if "digest" in table:
            verified(out / kind.file, table["offset"], table["digest"])
    state, model, room = simulation.state, simulation.model, len(simulation.state.pairs.a)
    for name, current in state.groups().items():
        setattr(state, name, checkpoint.restore(type(current), groups[name], where=str(file)))
    state.pairs = unpacked(state.pairs, max(room, len(state.pairs.a)))
    if state.watch:
        state.watch.restore(groups, meta["watch"], where=str(file))
    simulation.make_room()
    if "shapes" in groups:  # bodies have come or gone since the start
        arrays = {name: checkpoint.restore(type(getattr(model, name)), groups[name], where=str(file)) for name in REMODELLED}
        own, structures = model.structure_of[: model.floating], model.structure_of[model.floating :]
        since, ids = np.full(len(state.ids.body), -1), state.ids.body  # those that have come since are part of no structure
        since[ids < len(own)] = own[ids[ids < len(own)]]
        structure_of = np.concatenate([since, structures])
        simulation.adopt(model._replace(floating=len(state.ids.body), structure_of=structure_of, **arrays))
    return meta
