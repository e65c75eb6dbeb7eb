"""The kinds of structures there are. A new kind is a file beside this one, and its class in this list."""

from dilatedem.structures.box import Box
from dilatedem.structures.kind import Structure
from dilatedem.structures.pile import Pile
from dilatedem.structures.plane import Plane

KINDS: tuple[type[Structure], ...] = (Pile, Plane, Box)

#: class by what stands under `kind` in a case file
BY_NAME: dict[str, type[Structure]] = {kind.model_fields["kind"].annotation.__args__[0]: kind for kind in KINDS}
