"""Cases on a Dask cluster: an order goes to a worker, the files of its run come back with the answer, and no disk is shared.

A worker loads the program and its machine code once. Dask gives the case of a worker that dies to another one.
"""

import logging
import queue
import socket
import tempfile
import uuid
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from dilatedem import __version__
from dilatedem.errors import INTERRUPTED, WRONG, CaseError
from dilatedem.files.atomic import write_bytes
from dilatedem.output import folder
from dilatedem.processes.children import TICK_S, Answer
from dilatedem.processes.interruption import Interruption
from dilatedem.sweeps.orders import Order
from dilatedem.sweeps.progress import Progress

#: s that a scheduler has to answer
CONNECT_S = 10.0

Files = dict[str, bytes]  # of a run folder, by name


class Cluster:
    """The workers of a scheduler, `tcp://HOST:PORT`; see `orders.Executor`. Raises CaseError where none can be reached."""

    def __init__(self, address: str):
        self.stopping, self.fault = False, ""
        self._address, self._killed = address, False
        self._sweep = f"dilatedem-{uuid.uuid4().hex}"  # what workers and scheduler call this sweep

    def __enter__(self) -> "Cluster":
        self._client = _client(self._address)
        self._told: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        self._client.subscribe_topic(self._sweep, lambda event: self._told.put(tuple(event[1])))
        return self

    def __exit__(self, *exception) -> None:
        self._client.close(timeout=CONNECT_S)

    def carry_out(self, orders: Sequence[Order], progress: Progress) -> Iterator[tuple[int, Answer]]:
        workers = len(self._client.scheduler_info(n_workers=-1)["workers"])
        progress.message(f"workers at {self._address}: {workers or 'none yet; waiting for some'}")
        left = {number: self._submit(number, order) for number, order in enumerate(orders)}
        asked = False
        while left and not (self._killed or self.fault):
            if self.stopping and not asked:
                asked = True
                self._client.run(stop_there, self._sweep, on_error="ignore")
            number, what = self._hear()
            if number is None or isinstance(what, float):
                progress.tell(number, what or 0.0)
            elif answer := self._answer(orders[number], left.pop(number)):
                yield number, answer

    def interrupt(self) -> None:
        self.stopping = True  # whoever waits for answers tells the workers: a signal may come in the midst of their protocol

    def kill(self) -> None:
        self._killed = True

    def _submit(self, number: int, order: Order):
        files = packed(Path(order.out)) if order.resume else {}
        asked = (order, files, number, self._sweep, __version__)
        future = self._client.submit(run_there, *asked, key=f"{self._sweep}-{number}", pure=False)
        future.add_done_callback(lambda done: self._told.put((number, None)))
        return future

    def _hear(self) -> tuple[int | None, float | None]:
        """The number of a run and how far it is, None once it is over; no number where nothing was told for a while."""
        try:
            return self._told.get(timeout=TICK_S)
        except queue.Empty:
            return None, None

    def _answer(self, order: Order, future) -> Answer | None:
        """What came of an order; its files are in its folder then. None where nothing can come any more, which is a `fault`."""
        try:
            fault = future.exception()
            answer, files = (Answer(1, _words(fault)), {}) if fault else future.result()
        except (CancelledError, OSError) as lost:
            fault = lost
        if isinstance(fault, CancelledError | OSError):
            self.fault = f"the scheduler {self._address} is gone"
            return None
        future.release()
        unpack(files, Path(order.out))
        return answer


def _client(address: str):
    try:
        from distributed import Client
        from distributed.comm import get_address_host_port
    except ImportError:
        raise CaseError(f"--scheduler {address}: needs Dask: pip install 'dilatedem[cluster]'") from None
    for name in ("distributed", "distributed.client"):  # each has a level of its own
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what is wrong is told in our words
    try:
        socket.create_connection(get_address_host_port(address), CONNECT_S).close()  # Dask itself would try again and again
        return Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        cause = str(error) or type(error).__name__
        raise CaseError(f"--scheduler {address}: no scheduler answers there ({cause}); it is given as tcp://host:8786") from None


def _words(fault: BaseException) -> str:
    """Why a cluster did not carry out an order."""
    if type(fault).__name__ == "KilledWorker":
        return f"every worker that ran this case died ({fault.allowed_failures + 1} of them)"
    if isinstance(fault, ModuleNotFoundError):
        return f"a worker lacks a package: {fault}; install dilatedem in its environment"
    return f"{type(fault).__name__}: {fault}"


def run_there(order: Order, files: Files, number: int, sweep: str, version: str) -> tuple[Answer, Files]:
    """On a worker: a case run in a folder of its own there; its answer, and its files. `files`: those of a run that goes on."""
    from distributed import get_worker

    from dilatedem.sweeps.work import simulate

    if version != __version__:
        return Answer(WRONG, f"a worker has dilatedem {__version__}, this is {version}; install the same"), {}
    if _interruptions[sweep].asked:
        return Answer(INTERRUPTED), {}
    worker = get_worker()
    with tempfile.TemporaryDirectory(prefix="dilatedem-", dir=worker.local_directory, ignore_cleanup_errors=True) as place:
        there = Path(place, "run")
        unpack(files, there)
        tell = partial(_let_know, worker, sweep, number)
        answer = simulate(replace(order, out=str(there), overwrite=False), tell, _interruptions[sweep])
        return answer._replace(said=answer.said.replace(str(there), order.out)), packed(there)


#: of each sweep that has had a run in this process of a cluster
_interruptions: defaultdict[str, Interruption] = defaultdict(Interruption)


def stop_there(sweep: str) -> None:
    """On a worker: have the runs of a sweep save their state and end, and no other begin."""
    _interruptions[sweep].asked = True


def _let_know(worker, sweep: str, number: int, share: float) -> None:
    worker.log_event(sweep, [number, float(share)])


def packed(place: Path) -> Files:
    """All files of a run folder."""
    return {path.relative_to(place).as_posix(): path.read_bytes() for path in sorted(place.rglob("*")) if path.is_file()}


def unpack(files: Files, place: Path) -> None:
    """Write the files of a run folder, the summary last: what it says has happened. Earlier ones of a run give way."""
    if not files:
        return
    place.mkdir(parents=True, exist_ok=True)
    folder.clear(place)
    for name in sorted(files, key=lambda name: name == folder.SUMMARY):
        (place / name).parent.mkdir(exist_ok=True)
        write_bytes(place / name, files[name])
