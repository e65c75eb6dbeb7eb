"""The example cases: those of cases/, which a wheel holds inside the package (setup.py)."""

import difflib
import tomllib
from pathlib import Path

from dilatedem.errors import CaseError

_PACKAGE = Path(__file__).parent
#: inside the package where it was installed from a wheel; beside it in a checkout, and where that was installed with `-e`
FOLDER = next((folder for folder in (_PACKAGE / "cases", _PACKAGE.parent / "cases") if folder.is_dir()), _PACKAGE / "cases")


def names() -> list[str]:
    """Of all example cases, in alphabetical order."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def title(name: str) -> str:
    """What a case is, as it says of itself."""
    return tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))["title"]


def write(name: str, out: Path | None = None) -> list[Path]:
    """Write the case `name` to the file `out`, or into the folder `out`, with the tables that it names beside it.

    out: NAME.toml in the present folder unless given. Returns the files, the case first. Raises CaseError, before anything is
    written, for a name that there is not and for a file that there is.
    """
    if name not in names():
        close = difflib.get_close_matches(name, names(), n=1)
        hint = f"did you mean {close[0]}?" if close else f"there are {', '.join(names())}"
        raise CaseError(f"init {name}: there is no such example; {hint}")
    case = Path(f"{name}.toml") if out is None else out / f"{name}.toml" if out.is_dir() else out
    sources = [FOLDER / f"{name}.toml", *sorted(path for path in FOLDER.glob(f"{name}.*") if path.suffix != ".toml")]
    files = [case, *(case.with_name(source.name) for source in sources[1:])]
    for file in files:
        if file.exists() or file.is_symlink():
            raise CaseError(f"{file}: exists already, and is left as it is; choose another file with --out")
    case.parent.mkdir(parents=True, exist_ok=True)
    for source, file in zip(sources, files, strict=True):
        with file.open("xb") as new:  # never in place of what somebody else has just made
            new.write(source.read_bytes())
    return files
