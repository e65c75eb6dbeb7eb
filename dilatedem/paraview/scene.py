"""What view.py does within ParaView 5.11 or newer; it is copied behind the figures of a run, and not imported by the program."""

import argparse
import math
import os
import sys

import paraview
from paraview import simple

WHITE, DARK, WATER, STRUCTURE, ARROW = (1.0, 1.0, 1.0), (0.15, 0.2, 0.25), (0.81, 0.88, 0.93), (0.84, 0.37, 0.0), (0.55, 0.0, 0.1)
#: of the shorter side of the domain, how long the arrow of the largest force is
LONGEST_ARROW = 0.15
#: pixels; the camera's angle from lower to upper edge, as ParaView has it [deg]; room around the domain
SIZE, ANGLE, MARGIN = (1600, 1000), 30.0, 1.06
#: share of a colour that light does not change: sides in the shade stay what they are
AMBIENT = 0.4
FRAMES_PER_SECOND = 20


def show(run: dict, folder: str, *, contacts: bool, time: float | None = None):
    """Put a run on the screen; returns its view. time [s]: the last one unless given."""
    simple._DisableFirstRenderCameraReset()
    view = simple.CreateView("RenderView")
    view.ViewSize, view.OrientationAxesVisibility = list(SIZE), 1
    view.UseColorPaletteForBackground, view.Background, view.OrientationAxesLabelColor = 0, list(WHITE), list(DARK)
    ice = simple.PVDReader(registrationName="ice", FileName=os.path.join(folder, "ice.pvd"))
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    times = list(ice.TimestepValues) or [0.0]
    view.ViewTime = scene.AnimationTime = min(times, key=lambda at: abs(at - time)) if time is not None else times[-1]
    show_floes(ice, view)
    for name in run["structure_files"]:
        reader = simple.PVDReader if name.endswith(".pvd") else simple.XMLUnstructuredGridReader
        show_plain(reader(registrationName=name, FileName=os.path.join(folder, name)), view, STRUCTURE)
    show_water(run, view)
    if contacts:
        show_contacts(run, ice, times, view)
    stamp = simple.AnnotateTimeFilter(registrationName="time", Input=ice, Format="t = {time:.2f} s")
    write_words(stamp, view, "Upper Left Corner", 22)
    write_words(simple.Text(registrationName="title", Text=run["title"]), view, "Lower Left Corner", 14)
    look_from(run, view)
    return view


def show_floes(ice, view) -> None:
    """Floes by their speed, on one scale for all times."""
    floes = simple.Show(ice, view)
    floes.Representation, floes.EdgeColor, floes.LineWidth = "Surface With Edges", list(DARK), 1.0
    floes.Ambient, floes.Diffuse, floes.Specular = AMBIENT, 1.0 - AMBIENT, 0.0
    simple.ColorBy(floes, ("CELLS", "speed"))
    colours = simple.GetColorTransferFunction("speed")
    colours.ApplyPreset("Viridis (matplotlib)", True)
    floes.RescaleTransferFunctionToDataRangeOverTime()
    low, high = colours.RGBPoints[0], colours.RGBPoints[-4]
    colours.RescaleTransferFunction(0.0, high if high > 0.0 else 1.0) if low >= 0.0 else None
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle, bar.RangeLabelFormat, bar.LabelFormat = "speed, m/s", "", "%.2f", "%.2f"
    bar.TitleColor = bar.LabelColor = list(DARK)
    bar.TitleFontSize = bar.LabelFontSize = 18
    bar.AutomaticLabelFormat = 0
    bar.WindowLocation, bar.ScalarBarLength, bar.Orientation = "Upper Center", 0.26, "Horizontal"
    floes.SetScalarBarVisibility(view, True)


def show_plain(source, view, colour, **looks) -> None:
    """A thing of one colour."""
    display = simple.Show(source, view)
    display.ColorArrayName = ["POINTS", ""]
    display.Representation = looks.pop("representation", "Surface")
    display.AmbientColor = display.DiffuseColor = list(colour)
    display.Ambient, display.Diffuse = AMBIENT, 1.0 - AMBIENT
    for name, value in looks.items():
        setattr(display, name, value)


def show_water(run: dict, view) -> None:
    """The water level within the domain, and its sides."""
    x, y = (0.5 * side for side in run["size"])
    for name, height, looks in (
        ("water level", 0.0, {"colour": WATER, "Opacity": 0.7, "Ambient": 1.0, "Diffuse": 0.0}),
        ("domain", 0.0, {"colour": DARK, "representation": "Wireframe", "LineWidth": 2.0, "Ambient": 1.0}),
    ):
        corner = [-x, -y, height]
        plane = simple.Plane(registrationName=name, Origin=corner, Point1=[x, -y, height], Point2=[-x, y, height])
        show_plain(plane, view, looks.pop("colour"), **looks)


def show_contacts(run: dict, ice, times, view) -> None:
    """An arrow over each floe that touches something: the sum of its contact forces at that moment."""
    largest, when = largest_force(ice, times)
    if not largest > 0.0:
        write_words(simple.Text(Text="no contact forces in these snapshots"), view, "Upper Right Corner", 16)
        return
    loaded = simple.Threshold(registrationName="loaded", Input=ice, Scalars=["CELLS", "contacts"], UpperThreshold=1.0)
    loaded.ThresholdMethod = "Above Upper Threshold"
    centres = simple.CellCenters(registrationName="centres", Input=loaded)
    above = simple.Transform(registrationName="above", Input=centres)
    above.Transform.Translate = [0.0, 0.0, run["thickness"]]
    arrows = simple.Glyph(registrationName="contact forces", Input=above, GlyphType="Arrow")
    arrows.OrientationArray = arrows.ScaleArray = ["POINTS", "contact_force"]
    arrows.VectorScaleMode, arrows.GlyphMode = "Scale by Magnitude", "All Points"
    arrows.ScaleFactor = LONGEST_ARROW * min(run["size"]) / largest
    show_plain(arrows, view, ARROW)
    words = f"arrows: contact force on a floe, at most {largest / 1e3:.3g} kN in the snapshot of {when:.6g} s"
    write_words(simple.Text(registrationName="arrows", Text=words), view, "Upper Right Corner", 14)


def largest_force(ice, times) -> tuple[float, float]:
    """Of any floe at any time [N], and when [s]."""
    largest, when = 0.0, 0.0
    for time in times:
        ice.UpdatePipeline(time)
        array = ice.GetCellDataInformation().GetArray("contact_force")
        if array and array.GetNumberOfTuples() and array.GetRange(-1)[1] > largest:
            largest, when = array.GetRange(-1)[1], time
    return largest, when


def write_words(source, view, place: str, size: int) -> None:
    words = simple.Show(source, view)
    words.WindowLocation, words.FontSize, words.Color = place, size, list(DARK)


def look_from(run: dict, view) -> None:
    """From the side to which y is lowest, half way up, with all of the domain in sight: its near corners set the distance."""
    length, width = (MARGIN * side for side in run["size"])
    up = math.tan(math.radians(0.5 * ANGLE))
    aside, down = 0.5 * length / (up * SIZE[0] / SIZE[1]), 0.5 * width * math.sqrt(0.5) / up
    distance = 0.5 * width * math.sqrt(0.5) + max(aside, down)
    view.CameraFocalPoint, view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], ANGLE
    view.CameraPosition = [0.0, -distance * math.sqrt(0.5), distance * math.sqrt(0.5)]


def main(run: dict, folder: str, contacts: bool, movie: bool) -> None:
    """In the window of ParaView the run is shown; pvbatch and pvpython write a picture, or a film."""
    started = os.path.basename((getattr(sys, "argv", None) or [""])[0])  # pvbatch and pvpython name the script there
    if paraview.fromGUI or not started.endswith(".py"):
        simple.Render(show(run, folder, contacts=contacts))
        return
    asked = argparse.ArgumentParser(description="Writes a picture of the run, or a film.")
    asked.add_argument("--time", type=float, help="s; the last snapshot unless given")
    asked.add_argument("--picture", default=os.path.join(folder, "view.png"), help="file (PNG)")
    asked.add_argument("--movie", nargs="?", const=True, default=movie, help="a film of all snapshots, view.avi unless named")
    asked.add_argument("--contacts", action="store_true", default=contacts, help="contact forces as arrows")
    options = asked.parse_args()
    view = show(run, folder, contacts=options.contacts, time=options.time)
    simple.Render(view)
    simple.SaveScreenshot(options.picture, view, ImageResolution=list(SIZE))
    print(options.picture)
    if options.movie:
        film = os.path.join(folder, "view.avi") if options.movie is True else options.movie
        simple.SaveAnimation(film, view, ImageResolution=list(SIZE), FrameRate=FRAMES_PER_SECOND)
        print(film)
