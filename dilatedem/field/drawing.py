"""Floes drawn elsewhere: outlines of a GeoJSON, WKT or CSV file, and what it says of each."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely

#: bytes of the largest file
LARGEST = 2**26
#: by the end of a file's name
GEOJSON, WKT, CSV = (".geojson", ".json"), (".wkt", ".txt"), (".csv",)
SUFFIXES = (*GEOJSON, *WKT, *CSV)
#: columns that a CSV file must have
COLUMNS = ("floe", "x", "y")
#: numbers that are taken of an outline where they are given: the least that each may be, not itself, and the most
NUMBERS = {"thickness": (0.0, 1e7), "density": (0.0, 1e9), "elastic_modulus": (0.0, 1e21), "poisson_ratio": (-1e-300, 0.5)}
#: the same of two components [m/s]
VELOCITY, FASTEST = "velocity", 1e5


@dataclass(frozen=True)
class Outline:
    """An area of a file: in its units, and what the file says of it, as far as that is of use."""

    area: shapely.Geometry
    properties: dict[str, Any]


@dataclass(frozen=True)
class Drawing:
    """All areas of a file; entries: of the file, areas or not; unused: names of what it says besides."""

    outlines: list[Outline]
    entries: int
    unused: tuple[str, ...] = ()


def read(path: str | Path) -> Drawing:
    """The areas of a file. Raises ValueError, which names the place in the file, for one that cannot be read or understood."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
    except OSError as error:
        raise ValueError(f"cannot be read: {error.strerror}") from None
    if len(content) > LARGEST:
        raise ValueError(f"is larger than {LARGEST // 2**20} MB; take a part of it")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"is not UTF-8 text (byte {error.start})") from None
    suffix = path.suffix.lower()
    entries = list(_of_geojson(text) if suffix in GEOJSON else _of_wkt(text) if suffix in WKT else _of_csv(text))
    known = {*NUMBERS, VELOCITY}
    unused = sorted({name for _, properties in entries for name in properties if name not in known})
    areas = [entry for entry in entries if entry[0].geom_type in ("Polygon", "MultiPolygon") and not entry[0].is_empty]
    if not areas:
        raise ValueError(f"holds no area: {len(entries)} entries, none of them a polygon" if entries else "is empty")
    return Drawing(
        [Outline(shape, {name: properties[name] for name in known & set(properties)}) for shape, properties in areas],
        len(entries),
        tuple(unused),
    )


def _of_geojson(text: str) -> Iterator[tuple[shapely.Geometry, dict]]:
    """Shapes and properties of features, collections of them, or bare geometries."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"is not GeoJSON: {str(error).partition(chr(10))[0]}") from None
    items = data.get("features", data.get("geometries", [data])) if isinstance(data, dict) else None
    if not isinstance(items, list):
        raise ValueError("is not GeoJSON: it holds no feature and no geometry")
    for number, item in enumerate(items):
        where = f"feature {number}"
        if not isinstance(item, dict):
            raise ValueError(f"{where} is no feature and no geometry")
        is_feature = item.get("type") == "Feature"
        geometry, properties = (item.get("geometry"), item.get("properties") or {}) if is_feature else (item, {})
        if geometry is None:  # a feature without a place
            continue
        yield _finite(_shape(geometry, where), where), _checked(properties, where)


def _shape(geometry: Any, where: str) -> shapely.Geometry:
    try:
        return shapely.from_geojson(json.dumps(geometry))
    except (TypeError, ValueError, shapely.GEOSException) as error:
        raise ValueError(f"{where}: its geometry cannot be understood ({str(error).strip()})") from None


def _of_wkt(text: str) -> Iterator[tuple[shapely.Geometry, dict]]:
    """A geometry a line; empty lines, and those that begin with #, are left out."""
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            with np.errstate(invalid="ignore"):  # what is not finite is told below
                shape = shapely.from_wkt(line)
        except shapely.GEOSException as error:
            raise ValueError(f"line {number} is not WKT ({str(error).strip()})") from None
        yield _finite(shape, f"line {number}"), {}


def _of_csv(text: str) -> Iterator[tuple[shapely.Geometry, dict]]:
    """The points of each floe in the order of the rows; what else a row says of its floe, the first row counts."""
    rows = csv.DictReader(text.splitlines(), skipinitialspace=True)
    names = [(name or "").strip() for name in rows.fieldnames or ()]
    if missing := [name for name in COLUMNS if names.count(name) != 1]:
        raise ValueError(f"must begin with a line that names the columns {', '.join(COLUMNS)}; {missing[0]} is not there once")
    rows.fieldnames = names
    points: dict[str, list[tuple[float, float]]] = {}
    properties: dict[str, dict] = {}
    for row in rows:
        where, floe = f"line {rows.line_num}", (row["floe"] or "").strip()
        points.setdefault(floe, []).append((_number(row["x"], f"{where}: x"), _number(row["y"], f"{where}: y")))
        if floe not in properties:
            told = {name: _number(row[name], f"{where}: {name}") for name in NUMBERS if (row.get(name) or "").strip()}
            others = {name: None for name in names if name and name not in (*COLUMNS, *NUMBERS)}
            properties[floe] = _checked(told, where) | others
    for floe, corners in points.items():
        if len(corners) < 3:
            yield shapely.LineString(corners * (3 - len(corners))), {}
            continue
        yield shapely.Polygon(corners), properties[floe]


def _number(text: Any, where: str) -> float:
    try:
        value = float(text)
    except (TypeError, ValueError):
        raise ValueError(f"{where} = {text}: must be a number") from None
    if not math.isfinite(value):
        raise ValueError(f"{where} = {text}: must be finite")
    return value


def _finite(shape: shapely.Geometry, where: str) -> shapely.Geometry:
    """The shape in plan; heights of its points are left out."""
    if not np.isfinite(shapely.get_coordinates(shape)).all():
        raise ValueError(f"{where}: holds a coordinate that is not finite")
    return shapely.force_2d(shape)


def _checked(properties: Any, where: str) -> dict[str, Any]:
    """Properties whose known ones are what they should be; those that are null count as not given."""
    if not isinstance(properties, dict):
        raise ValueError(f"{where}: its properties are no table")
    told = {str(name): value for name, value in properties.items() if value is not None}
    for name, (least, most) in NUMBERS.items():
        value = told.get(name, most / 2)
        if isinstance(value, bool) or not isinstance(value, int | float) or not least < value < most:
            raise ValueError(f"{where}: {name} = {value}: must be a number {_bounds(least, most)}")
        told |= {name: float(value)} if name in told else {}
    if VELOCITY in told:
        value = told[VELOCITY]
        if not _is_pair(value):
            raise ValueError(f"{where}: {VELOCITY} = {value}: must be a list of 2 numbers, along x and y in m/s")
        told[VELOCITY] = tuple(map(float, value))
    return told


def _bounds(least: float, most: float) -> str:
    return f"from 0 up to {most:g}" if least < 0.0 else f"greater than 0, in SI units, and below {most:g}"


def _is_pair(value: Any) -> bool:
    numbers = isinstance(value, list | tuple) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in value)
    return numbers and len(value) == 2 and all(abs(x) <= FASTEST for x in value)
