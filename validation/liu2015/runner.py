"""Runs the plan: each run is a process of its own, in its own folder; what is done is kept, what was interrupted goes on."""

from __future__ import annotations

import ast
import hashlib
import json
import os
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from dilatedem.case.load import load
from validation.liu2015.plan import TYPICAL_WALL, Run

PACKAGE = Path("dilatedem")
#: parts of the package that cannot change a number of a run
WITHOUT_PHYSICS = ("post", "cli.py", "sweep.py", "generate.py")
#: beside the files of a run: digest of the sources that it was started with
SOURCES = "sources.txt"

STOPPED_BY_USER = 130
WRONG_CASE = 2


def source_digest() -> str:
    """Digest of the code of the simulation, comments and docstrings left out."""
    digest = hashlib.sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE)
        if name.parts[0] in WITHOUT_PHYSICS:
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            body = getattr(node, "body", None)
            if isinstance(body, list) and body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
                del body[0]
        digest.update(f"{name.as_posix()}\n{ast.dump(tree)}\n".encode())
    return digest.hexdigest()[:12]


def summary(folder: Path) -> dict:
    """summary.json of a run, empty where there is none."""
    try:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def completed(folder: Path) -> bool:
    return summary(folder).get("status") == "completed"


def sources_of(folder: Path) -> str:
    """Digest of the sources a run was started with; empty where it is not known."""
    try:
        return (folder / SOURCES).read_text(encoding="utf-8").strip()
    except OSError:
        return ""


def estimate(runs: Sequence[Run], root: Path, jobs: int) -> float:
    """Wall time [s] of these runs, from the runs of the same size and model that are done, else from TYPICAL_WALL."""
    known: dict[tuple[str, str], list[float]] = {}
    for run in runs:
        if completed(run.folder(root)):
            known.setdefault((run.model, run.size), []).append(float(summary(run.folder(root))["wall_s"]))
    waiting = Counter((run.model, run.size) for run in runs if not completed(run.folder(root)))
    total = 0.0
    for kind, count in waiting.items():
        done = known.get(kind)
        total += count * (sum(done) / len(done) if done else TYPICAL_WALL[kind[1]])
    return total / jobs


class Runner:
    """Works through a plan with a few processes at a time.

    settings: further KEY=VALUE for every run. limit: s after which no new run is started. renew: run again what was made
    with other sources.
    """

    def __init__(self, root: Path, *, settings: Sequence[str] = (), jobs: int, limit: float | None, renew: bool):
        self.root, self.settings, self.jobs, self.renew = root, list(settings), jobs, renew
        self.end = None if limit is None else time.monotonic() + limit
        self.lock = threading.Lock()
        self.processes: set[subprocess.Popen] = set()
        self.refused: set[str] = set()  # models that the program does not take
        self.stopping = False

    def work(self, runs: Sequence[Run]) -> None:
        """Run what is missing. Ctrl-C and SIGTERM (as KeyboardInterrupt) save the state of what runs now and pass on."""
        self._refuse_foreign(runs)
        digest = source_digest()
        self._refuse_mixture(runs, digest)
        waiting = [run for run in runs if not self._keeps(run, digest)]
        say(f"{len(runs)} runs in {self.root}, {len(runs) - len(waiting)} done before, {self.jobs} at a time")
        if not waiting:
            return
        # or the first two processes would compile the same kernels side by side
        for model in sorted({run.model for run in waiting}):
            compile_once = f"from dilatedem.run.loop import compile_kernels; compile_kernels(model={model!r})"
            subprocess.run([sys.executable, "-c", compile_once], capture_output=True, check=False)
        with ThreadPoolExecutor(self.jobs) as pool:
            futures = [pool.submit(self._run, run, f"[{i}/{len(waiting)}]") for i, run in enumerate(waiting, start=1)]
            try:
                for future in futures:
                    future.result()
            except KeyboardInterrupt:
                say("stopping; the running runs save their state")
                self._interrupt()
                pool.shutdown(cancel_futures=True)
                raise

    def _keeps(self, run: Run, digest: str) -> bool:
        folder = run.folder(self.root)
        return completed(folder) and not (self.renew and sources_of(folder) != digest)

    def _refuse_foreign(self, runs: Sequence[Run]) -> None:
        """Raises ValueError when a folder of the plan holds another case, as after a change of `settings`."""
        for run in runs:
            written = run.folder(self.root) / "case.toml"
            if written.exists() and load(written) != load(run.case, [*run.overrides(), *self.settings]):
                raise ValueError(f"{written}: is not the case of this plan; choose another --runs, or remove that folder")

    def _refuse_mixture(self, runs: Sequence[Run], digest: str) -> None:
        """Raises ValueError when done runs of the plan are of other sources, and so are not to be compared with new ones."""
        foreign = [sources_of(run.folder(self.root)) or "unknown" for run in runs if completed(run.folder(self.root))]
        foreign = [state for state in foreign if state != digest]
        if foreign and not self.renew:
            raise ValueError(
                f"{self.root}: {len(foreign)} runs were made with other sources ({', '.join(sorted(set(foreign)))}) "
                f"than these ({digest}); --renew makes them anew, another --runs keeps them"
            )

    def _run(self, run: Run, place: str) -> None:
        late = self.end is not None and time.monotonic() > self.end
        if self.stopping or late or run.model in self.refused:
            return
        folder, digest = run.folder(self.root), source_digest()
        same = sources_of(folder) == digest
        command = [sys.executable, "-m", "dilatedem.cli", "run", str(run.case), "--out", str(folder), "--quiet"]
        for setting in [*run.overrides(), *self.settings]:
            command += ["--set", setting]
        if (folder / "case.toml").exists():  # go on, but not with other laws than those it was begun with
            going_on = same and (folder / "restart.h5").exists() and not completed(folder)
            command.append("--resume" if going_on else "--overwrite")
        started = time.monotonic()
        with self.lock:
            if self.stopping:
                return
            # a session of its own: Ctrl-C reaches it through us, once
            process = subprocess.Popen(
                command,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
                env={**os.environ, "NUMBA_NUM_THREADS": "1"},
                start_new_session=True,
            )
            self.processes.add(process)
        _, said = process.communicate()
        with self.lock:
            self.processes.discard(process)
        if folder.exists():
            (folder / SOURCES).write_text(f"{digest}\n", encoding="utf-8")
        words = {0: "completed", STOPPED_BY_USER: "interrupted"}.get(process.returncode, "; ".join(said.split("\n")[-3:]))
        if process.returncode == WRONG_CASE:
            self.refused.add(run.model)
            words = f"refused; no further runs of this model are started: {said.strip()}"
        say(f"{place} {run.name}: {words} ({time.monotonic() - started:.0f} s)")

    def _interrupt(self) -> None:
        with self.lock:
            self.stopping = True
            for process in self.processes:
                process.send_signal(2)


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
