"""What a run cannot tell: the limits of its models, as the report of it says."""

from dilatedem.post.read import RunFolder

RIGID = "Floes are rigid: they do not crush, split, raft or ridge, though some of these peaks would break real ice."
CRUSHING = "Floes crush where they touch, at one pressure; they do not split, bend, raft or ridge. What has crushed is gone."
LIMITS = (
    "Peaks last tens of milliseconds, and their height and number vary from one random field to the next: "
    "judge by several seeds, not by one run.",
    "Times of hits above their threshold are counted in whole windows of forces.csv, too long by up to two windows each.",
)
LIMITS_OF_CURRENT = "The water is a current without waves, and the ice does not change its flow."
LIMITS_OF_WAVES = (
    "Waves ride on a current; ice and structures change neither, and each floe lies in one plane of the surface: floes that are "
    "not short against the waves feel too much of them."
)
LIMITS_OF_WETTED = (
    " Its drag acts on the whole wetted surface of a floe: about ten times the drag of a formula for the frontal area."
)
LIMITS_OF_HELD = "The structure does not give way; its own compliance would soften the peaks."
LIMITS_OF_LIU2015 = (
    "Contact laws are those of Liu, Long & Ji (2015), mode by mode. They jump where a contact changes its "
    "mode, by factors up to some hundreds at 0.1 mm overlap; the laws for parallel edges stand for a contact "
    "one metre long and are far softer than elasticity; restitution depends on speed. The energy that the "
    "jumps create is booked as gain_law in the ledger."
)
UNFINISHED = "This run did not reach its end: everything here covers only the part that was simulated."


def limits(run: RunFolder) -> list[str]:
    """What the reader must not expect of these numbers."""
    sentences = [CRUSHING if run.case.get("ice", {}).get("crushing_pressure") is not None else RIGID, *LIMITS]
    flow = LIMITS_OF_WAVES if run.case.get("wave") else LIMITS_OF_CURRENT
    sentences.insert(1, flow + (LIMITS_OF_WETTED if run.case.get("water", {}).get("drag", "wetted") == "wetted" else ""))
    if not run.motion:
        sentences.insert(1, LIMITS_OF_HELD)
    if run.case.get("contact", {}).get("model", "liu2015") == "liu2015":
        sentences.insert(0, LIMITS_OF_LIU2015)
    if run.summary.get("status") != "completed":
        sentences.insert(0, UNFINISHED)
    return sentences
