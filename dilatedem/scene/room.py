"""Whether a field of ice can be built at all: foretold from its numbers, before anything is made."""

import math
import os
from pathlib import Path

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.field.sizes import floe_count
from dilatedem.state.storage import MOST_CORNERS

#: corners of a face after clipping by another: both counts together have to fit into the workspace
MOST_FACE_CORNERS = MOST_CORNERS // 2 - 1
#: bytes that a floe takes up in a run, about: its shape, its neighbours, what waits to be written; half of it while it is checked
BYTES_PER_FLOE = 10_000
#: bytes that the program takes up by itself, about
BYTES_OF_PROGRAM = 300_000_000
#: bytes that there are where the system does not tell
USUAL_MEMORY = 16 * 2**30
#: mean spacings of the floes that the shorter side of a domain is long, at least: such floes are 16 times longer than wide
NARROWEST = 0.25
#: where Linux says how much memory a group of processes may take
_GROUP_LIMITS = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))


def memory(bodies: int) -> float:
    """What a run of so many bodies takes up, about [bytes]."""
    return BYTES_OF_PROGRAM + BYTES_PER_FLOE * bodies


def generated_floes(case: Case) -> int:
    """Number of floes that a case asks for, before those that touch something are left out; a lattice may have a few more or less.

    Raises CaseError for more than the memory of this machine holds, and for a domain that is too narrow for them.
    """
    field, size = case.field, case.domain.size
    key, value = ("floe_count", field.floe_count) if field.floe_count else ("floe_size", field.asked_size)
    try:
        count = field.floe_count or floe_count(size, field.concentration, field.asked_size)
    except ValueError as fault:
        raise CaseError(f"the ice field cannot be built: {fault}") from fault
    there = memory_of_machine()
    if memory(count) > there:
        most = max(1, int((there - BYTES_OF_PROGRAM) / BYTES_PER_FLOE))
        raise CaseError(
            f"field.{key} = {value:g}: makes {count:g} floes, which take some {memory(count) / 1e9:.3g} GB of memory; there are "
            f"{there / 1e9:.3g} GB here, enough for some {most:.2g}: take larger floes, a smaller domain, or fewer floes"
        )
    spacing = math.sqrt(size[0] * size[1] / count)
    if min(size) < NARROWEST * spacing:
        axis = int(size[1] < size[0])
        raise CaseError(
            f"domain.size.{axis} = {size[axis]:g}: must be at least {NARROWEST * spacing:.3g} m, a quarter of the mean spacing of "
            f"{count} floes in a domain of {size[0]:g} m x {size[1]:g} m; widen the domain or take smaller floes"
        )
    return count


def memory_of_machine() -> float:
    """Memory that this process may take at most [bytes]."""
    try:
        limits = [float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")]
    except (AttributeError, ValueError, OSError):  # Windows
        limits = [float(USUAL_MEMORY)]
    for path in _GROUP_LIMITS:
        try:
            limits.append(float(path.read_text()))
        except (OSError, ValueError):  # no such file, or `max`
            continue
    return min(limits)
