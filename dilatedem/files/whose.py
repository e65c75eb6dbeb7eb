"""Whose files are those in a folder: the program replaces and removes what it wrote, and nothing else."""

import os
import re
import stat
from collections.abc import Iterable
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.files.atomic import TEMPORARY

#: the first line of a case.toml that a run wrote; a case that somebody wrote has none
MARK = re.compile(rb"# dilatedem \S+, seed -?\d+\s")


def is_marked(case: Path) -> bool:
    """Whether a run wrote this case.toml."""
    try:
        if not stat.S_ISREG(os.lstat(case).st_mode):
            return False
        with open(case, "rb") as file:
            return MARK.match(file.readline(200)) is not None
    except OSError:
        return False


def refuse_links(paths: Iterable[Path]) -> None:
    """Raises CaseError for the first of these paths, and of the temporary ones beside them, that is a link."""
    for path in paths:
        for place in (path, path.with_name(path.name + TEMPORARY)):
            if place.is_symlink():
                raise CaseError(f"{place}: is a link, and nothing is written through links; move it away or choose another folder")


def refuse_other_kinds(files: Iterable[Path], folders: Iterable[Path]) -> None:
    """Raises CaseError for a folder in place of a file, or the other way round: it could be neither replaced nor removed."""
    wrong = [(path, "no file") for path in files if path.exists() and not path.is_file()]
    wrong += [(path, "no folder") for path in folders if path.exists() and not path.is_dir()]
    if wrong:
        raise CaseError(f"{wrong[0][0]}: stands in the way: it is {wrong[0][1]}; move it away or choose another folder")


def refuse_foreign(folder: Path, paths: Iterable[Path], what: str) -> None:
    """Raises CaseError for the first of these paths where there is anything but an empty folder.

    what: "run" or so, of which the folder holds none
    """
    for path in paths:
        for place in (path, path.with_name(path.name + TEMPORARY)):
            if os.path.lexists(place) and not _is_empty_folder(place):
                no_right = f"{folder} holds no {what} that could be replaced"
                raise CaseError(f"{place}: stands in the way: {no_right}; move it away or choose another folder")


def _is_empty_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink() and not any(path.iterdir())


def matching(folder: Path, pattern: re.Pattern[str]) -> list[Path]:
    """What a folder holds under names of this pattern, in order; nothing where it is none, or a link."""
    if folder.is_symlink() or not folder.is_dir():
        return []
    return sorted(path for path in folder.iterdir() if pattern.fullmatch(path.name))
