"""The kinds of structures there are. A new kind is a file beside this one, and its class in the list SINGLE."""

from typing import Annotated, Union

from pydantic import Field

from dilatedem.structures.box import Box
from dilatedem.structures.brace import Brace
from dilatedem.structures.cone import Cone
from dilatedem.structures.kind import Structure
from dilatedem.structures.mesh import Mesh
from dilatedem.structures.parts import Parts
from dilatedem.structures.pier import Pier
from dilatedem.structures.pile import Pile
from dilatedem.structures.plane import Plane

#: what a part of a structure may be
SINGLE: tuple[type[Structure], ...] = (Pile, Cone, Plane, Box, Brace, Pier, Mesh)
KINDS: tuple[type[Structure], ...] = (*SINGLE, Parts)

Parts.model_rebuild(_types_namespace={"Single": Annotated[Union[SINGLE], Field(discriminator="kind")]})  # noqa: UP007

#: class by what stands under `kind` in a case file
BY_NAME: dict[str, type[Structure]] = {kind.model_fields["kind"].annotation.__args__[0]: kind for kind in KINDS}
