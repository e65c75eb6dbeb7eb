"""Indices of arrays taken as they are: no kernel counts from an array's end.

Because of Python's `array[-1]` Numba asks every index whether it is negative, a sixth of the time of a step.
"""

from numba import types
from numba.core import event

from dilatedem.jit.inside import inside

#: how the names of modules begin whose functions are compiled so
OWN = "dilatedem."
#: what asks, where Numba has it; a Numba that looks otherwise inside asks on
PLACE, NAME = "np.arrayobj", "fix_integer_index"


def _as_it_is(context, builder, kind, index, size):
    return context.cast(builder, index, kind, types.intp if kind.signed else types.uintp)


class IndicesAsTheyAre(event.Listener):
    """Has indices looked at in what is compiled of others, and not in what is compiled of this package, one within the other.

    Numba holds a lock around all of it.
    """

    def __init__(self):
        self._usual, self._open = None, []

    def on_start(self, event):
        place = inside(PLACE)  # loaded by now: something is compiled
        if not hasattr(place, NAME):
            return
        self._open.append(getattr(place, NAME))
        self._usual = self._usual or self._open[0]
        function = getattr((event.data or {}).get("dispatcher"), "py_func", None)
        setattr(place, NAME, _as_it_is if getattr(function, "__module__", "").startswith(OWN) else self._usual)

    def on_end(self, event):
        if self._open:
            setattr(inside(PLACE), NAME, self._open.pop())
