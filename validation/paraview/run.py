"""What `dilatedem paraview` writes, run by ParaView without a window: a picture, and what is in it; a film.

    python -m validation.paraview.run OUT

from the root of the repository, with ParaView (`apt install paraview python3-paraview xvfb`): a minute or two. Writes the picture
and the table of README.md; the run goes to OUT.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

from dilatedem.case.load import load
from dilatedem.paraview.script import write_script
from dilatedem.run import loop
from validation.paraview.picture import colours_of, pvbatch

HERE = Path(__file__).parent
CASE = HERE.parents[1] / "cases" / "legs.toml"
START, END = "<!-- table: written by validation/paraview/run.py -->", "<!-- end of the table -->"
#: s: the run, and the snapshot that is shown, in which floes press
DURATION, SHOWN = 6.0, 5.0
#: of the pixels, what each colour has at least
LEAST = {"ground": 0.3, "water": 0.1, "floes": 0.15, "structures": 0.005, "arrows": 2e-5}
#: bytes of a film of the run, at least: one still picture is less
FILM = 300_000


def main(out: Path) -> None:
    loop.run(load(CASE, [f"time.duration={DURATION}"]), out, overwrite=out.exists())
    script = write_script(out, contacts=True, movie=True)
    done = pvbatch(script, "--time", SHOWN)
    if done.returncode:
        sys.exit(done.stderr)
    image = Image.open(out / "view.png").convert("RGB")
    shares, film = colours_of(np.asarray(image)), (out / "view.avi").stat().st_size
    image.resize((960, 600)).save(HERE / "view.png", optimize=True)
    version = subprocess.run(["pvbatch", "--version"], capture_output=True, text=True, check=False)
    rows = [f"| {name} | {share:.4f} | {LEAST[name]:g} |" for name, share in shares.items()]
    said = (version.stdout + version.stderr).strip().splitlines()[-1]
    head = ["| colour | share of the pixels | at least |", "| --- | --- | --- |"]
    table = [*head, *rows, "", f"{said}; film of {film / 1e6:.1f} MB."]
    page = HERE / "README.md"
    before, _, after = page.read_text().partition(START)
    page.write_text(f"{before}{START}\n" + "\n".join(table) + f"\n{END}{after.partition(END)[2]}")
    missing = [name for name, share in shares.items() if share < LEAST[name]]
    if missing or film < FILM:
        sys.exit(f"not in the picture: {', '.join(missing)}" if missing else "the film is empty")
    print("\n".join(table))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
