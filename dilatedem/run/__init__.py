"""A simulation on its way through time: the composition root, the loop, and what is written on the way.

The room answers to `dilatedem.run(case, out)` as well: it can be called, and does what `dilatedem.run.loop.run_case` does.
"""

import sys
from types import ModuleType


class _Room(ModuleType):
    def __call__(self, case, out=None, **more):
        from dilatedem.run.loop import run_case  # compiled code, only when it is wanted

        return run_case(case, out, **more)


sys.modules[__name__].__class__ = _Room
