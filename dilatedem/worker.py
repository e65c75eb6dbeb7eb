"""A process that runs one case of a sweep after another: the program and its machine code are loaded once.

Each line of its standard input is an order in JSON, {"case": text of a case file, "out": run folder, "resume": false,
"overwrite": false} or {"compile": {of `Case.laws`}}. A line of its standard output answers each,
{"code": exit code, "said": all that the command would have written to standard error}.
"""

import gc
import io
import json
import sys
import traceback
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

from dilatedem.case.load import Source, build
from dilatedem.endings import ending
from dilatedem.errors import INTERRUPTED
from dilatedem.garbage import seldom_collected
from dilatedem.processes import lifeline
from dilatedem.run.loop import compile_kernels, run


def main() -> None:
    lifeline.watch()
    answers = sys.stdout
    with seldom_collected():
        for line in sys.stdin:
            said = io.StringIO()
            with redirect_stdout(said), redirect_stderr(said):
                code = _carry_out(json.loads(line))
            print(json.dumps({"code": code, "said": said.getvalue()}), file=answers, flush=True)
            gc.collect()


def _carry_out(order: dict[str, Any]) -> int:
    """Exit code of the command that an order stands for."""
    try:
        if "compile" in order:
            compile_kernels(**order["compile"])
        else:
            case = build(Source("<stdin>", order["case"]), [])
            run(case, Path(order["out"]), resume=order["resume"], overwrite=order["overwrite"], quiet=True)
    except BaseException as error:
        known = ending(error, can_resume=True)
        print(known[0] if known else traceback.format_exc(), file=sys.stderr)
        return known[1] if known else 1
    return 0


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:  # between two orders
        raise SystemExit(INTERRUPTED) from None
