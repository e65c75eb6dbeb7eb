"""The time step by stage: the program's own `advance`, with a clock that it reads between its stages."""

from dilatedem.jit import NoTimer, Timer, kernel, lap, timer_of
from dilatedem.state.clock import Status
from dilatedem.step.stages import STAGES


@kernel
def _read_clock(readings, timer):
    for _ in range(readings):
        lap(timer, 0)


def clock_cost(readings: int = 200_000) -> float:
    """What one reading of the clock adds to a stage, ns: the best of five rounds."""

    def spent() -> float:
        timer = timer_of(1)
        _read_clock(1, timer)
        timer.booked[:] = 0
        _read_clock(readings, timer)
        return float(timer.booked[0, 0])

    return min(spent() for _ in range(5)) / readings


def timed(simulation, steps: int, *, calls: int = 1) -> tuple[dict[str, float], float]:
    """Advance a simulation whose pairs have room, in so many calls; returns us a step by stage, less the clock's share, and awake
    pairs."""
    timer, evaluations = timer_of(len(STAGES)), simulation.state.clock.evaluations
    before, taken = int(evaluations[0]), 0
    simulation.timer = timer
    try:
        for call in range(1, calls + 1):
            piece, taken = steps * call // calls - taken, steps * call // calls
            status = simulation.advance(piece)
            if status != Status.DONE:
                raise RuntimeError(f"the timed run came back with {status.name}")
    finally:
        simulation.timer = NoTimer()
    return by_stage(timer, steps), (int(evaluations[0]) - before) / steps


def by_stage(timer: Timer, steps: int) -> dict[str, float]:
    """us a step of each stage, less what reading the clock took."""
    cost = clock_cost()
    return {
        stage: max(0.0, total - readings * cost) / steps * 1e-3
        for stage, (total, readings) in zip(STAGES, timer.booked.tolist(), strict=True)
    }
