"""How `post` writes figures and shows reports: what the options --format and --open ask for."""

import webbrowser
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from dilatedem.commands.manners import busy, whisper
from dilatedem.errors import CaseError
from dilatedem.post.figures import canvas


@contextmanager
def written_as(formats: Sequence[str] | None) -> Iterator[None]:
    """Within, figures are written as these kinds of files, and each is told of. Raises CaseError for a kind that there is not."""
    kinds = list(dict.fromkeys(formats or canvas.USUAL_FORMATS))
    if strange := [kind for kind in kinds if kind not in canvas.FORMATS]:
        raise CaseError(f"--format {strange[0]}: must be one of {', '.join(canvas.FORMATS)}")
    with busy() as tell, canvas.writing(kinds, tell):
        yield


def opened(report: Path) -> None:
    """Show a report in the browser of the user."""
    if not webbrowser.open(report.resolve().as_uri()):
        whisper(f"{report}: there is no browser here to open it")
