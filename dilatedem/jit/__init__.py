"""The only place that configures Numba, and the only one that knows it; of Numba, its public interface alone.

Editing an imported module does not invalidate the cache of its callers, and stale machine code gives stale answers. So the
cache lives in a folder named by a digest of all sources that kernels are made of, set before any decorator runs (2 ms), within the
user's NUMBA_CACHE_DIR where there is one. Four decorators:

kernel       a loop that Python calls; cached on disk
item         a stage of the step, or the work on one body or pair: merged into what calls it
device       any other function that kernels call
shared_loop  a `prange` over blocks

and `by_type`, which chooses among functions while a kernel is compiled. Some things have no public way and are left out where Numba
does not offer them: saving machine code one process after the other and loading it without what compiles (`cache.tend_cache`),
asking what is on disk (`is_cached`), indices that nobody looks at (`indices`).
"""

from dilatedem.jit.cache import LOCK, is_cached, source_digest
from dilatedem.jit.decorators import by_type, device, item, kernel, shared_loop
from dilatedem.jit.prefetch import CACHE_LINE, prefetch
from dilatedem.jit.threads import Alone, Team, prange, share_among, start_threads
from dilatedem.jit.timer import NoTimer, Timer, lap, timer_of

__all__ = [
    "CACHE_LINE", "LOCK", "Alone", "NoTimer", "Team", "Timer", "by_type", "device", "is_cached", "item", "kernel", "lap", "prange",
    "prefetch", "share_among", "shared_loop", "source_digest", "start_threads", "timer_of",
]  # fmt: skip
