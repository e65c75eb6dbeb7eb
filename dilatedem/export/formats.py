"""Tables of a structure's loads as other programs read them: CSV, a force file of OpenFAST, amplitudes of Abaqus."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from dilatedem.export.heights import Spread
from dilatedem.export.history import History

#: columns, in the order of the degrees of freedom 1 to 6
COMPONENTS = ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")
#: pairs of time and value in a line of Abaqus, at most
PAIRS = 4
#: letters of a label of Abaqus, at most, with what is put behind a structure's name
LONGEST_LABEL = 80 - len("_FX")


@dataclass(frozen=True)
class Loads:
    """What is known of the loads on a structure: six histories of one step, by COMPONENTS, and sentences that describe them."""

    structure: str
    histories: dict[str, History]
    about: list[str]

    def rows(self) -> Iterable[list[float]]:
        """Time and the six components, sample by sample."""
        columns = [self.histories["fx_N"].time, *(self.histories[name].value for name in COMPONENTS)]
        return zip(*(column.tolist() for column in columns), strict=True)


def as_csv(loads: Loads) -> str:
    """Comma separated, comments in lines that begin with #."""
    lines = [",".join(_digits(row)) for row in loads.rows()]
    return "\n".join([*_comments("#", loads.about), ",".join(("time_s", *COMPONENTS)), *lines, ""])


def as_openfast(loads: Loads) -> str:
    """A force file of a structural control (StC_DOF_MODE = 4): time, three forces, three moments."""
    about = [
        *loads.about,
        "for OpenFAST: StC_DOF_MODE = 4, PrescribedForcesCoord = 1 (global), PrescribedForcesFile = this file;",
        "put the structural control where moments are stated about; OpenFAST joins the rows by straight lines",
        "time_s " + " ".join(COMPONENTS),
    ]
    return "\n".join([*_comments("#", about), *("  ".join(_digits(row)) for row in loads.rows()), ""])


def as_abaqus(loads: Loads) -> str:
    """Six amplitudes, to be included in an input file; reference loads of 1 N and 1 N m make them loads."""
    label = _label(loads.structure)
    uses = [f"*CLOAD, AMPLITUDE={label}_{_short(name)}   NODE, {k}, 1.0" for k, name in enumerate(COMPONENTS, start=1)]
    about = [*loads.about, "*INCLUDE this file before the steps; then, at a node where moments are stated about,", *uses]
    blocks = [_amplitude(f"{label}_{_short(name)}", loads.histories[name]) for name in COMPONENTS]
    return "\n".join([*_comments("**", about), *blocks, ""])


def heights_as_csv(structure: str, spread: Spread, about: list[str]) -> str:
    """A row per height: the share of the load that a node there bears."""
    mean = spread.impulse / spread.duration
    columns = (spread.edges[:-1], spread.edges[1:], spread.middle, spread.impulse, mean, spread.share)
    lines = [",".join(_digits(row)) for row in zip(*(column.tolist() for column in columns), strict=True)]
    return "\n".join([*_comments("#", about), "z_bottom_m,z_top_m,z_m,impulse_Ns,mean_N,share", *lines, ""])


#: by the name of the format: the suffix of its files, and what writes them
FORMATS: dict[str, tuple[str, Callable[[Loads], str]]] = {
    "csv": ("csv", as_csv), "openfast": ("dat", as_openfast), "abaqus": ("inp", as_abaqus),
}  # fmt: skip


def _amplitude(name: str, history: History) -> str:
    pairs = [", ".join(_digits(pair)) for pair in zip(history.time.tolist(), history.value.tolist(), strict=True)]
    lines = [", ".join(pairs[i : i + PAIRS]) for i in range(0, len(pairs), PAIRS)]
    return "\n".join([f"*AMPLITUDE, NAME={name}, DEFINITION=TABULAR, TIME=TOTAL TIME, VALUE=RELATIVE", *lines])


def _digits(row: Iterable[float]) -> list[str]:
    return [f"{value + 0.0:.9g}" for value in row]  # + 0.0: no minus before a zero


def _comments(mark: str, lines: Iterable[str]) -> list[str]:
    return [f"{mark} {line}" for line in lines]


def _short(component: str) -> str:
    """FX of fx_N."""
    return component.partition("_")[0].upper()


def _label(structure: str) -> str:
    """A structure's name as a label of Abaqus: letters, digits and _, a letter first."""
    return re.sub(r"\W", "_", structure, flags=re.ASCII).upper()[:LONGEST_LABEL]
