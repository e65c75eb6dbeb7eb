"""The command `dilatedem`, and `python -m dilatedem`."""

from dilatedem.errors import INTERRUPTED
from dilatedem.processes import interrupts


def main() -> None:
    """The command line, with Ctrl-C heard from the first moment on: loading what it needs takes a while."""
    try:
        with interrupts.heard_once():
            from dilatedem import cli

            cli.main()
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


if __name__ == "__main__":
    main()
