"""Cases as nobody should write them: extreme values, other types, keys that are none, texts that were cut and stirred."""

import copy
import math
import random
import tomllib
from typing import Any

import tomli_w

NUMBERS = [
    0, -1, 1, 2, 3, 7, 127, 128, 10_000_000_000, 2**63 - 1, -(2**63), 2**64, 10**30, 0.0, -0.0, 1e-300, 5e-324, 1e-100, 1e-12, 1e-9,
    1e-6, 1e-3, 0.1, 0.5, 0.999999, 1.0, 1.5, 10.0, 100.0, 1e4, 1e7, 1.0001e7, 1e10, 1e15, 1e20, 1e100, 1e300, 1.7e308, -1e-9, -0.5,
    -10.0, -1e7, -1e300, math.inf, -math.inf, math.nan,
]  # fmt: skip
TEXTS = [
    "", "auto", "all", "current", "open", "periodic", "wall", "outflow", "inflow", "pile", "plane", "box", "voronoi", "bodies",
    "liu2015",
    "consistent", "total", "wall_x_min", "body_0", "a/b", "a.b", "a,b", "\u001b[31m", "\u202e", "\n", "x" * 5000, "\u00e4\u6c37",
]  # fmt: skip
KEYS = ["size", "radius", "center", "velocity", "position", "outline", "vertices", "kind", "name", "fixed", "x\u001by", "", "a b"]
FACTORS = [0.0, 1e-300, 1e-9, 1e-3, 0.1, 0.5, 0.9, 1.1, 2.0, 3.0, 1e3, 1e9, 1e300, -1.0]


def extreme(rng: random.Random, depth: int = 0) -> Any:
    """Some value, of any type."""
    kind = rng.random()
    if kind < 0.55:
        return rng.choice(NUMBERS)
    if kind < 0.7:
        return rng.choice(TEXTS)
    if kind < 0.78:
        return rng.random() < 0.5
    if kind < 0.95 or depth > 3:
        return [rng.choice(NUMBERS) for _ in range(rng.choice([0, 1, 2, 2, 3, 3, 4, 200]))]
    if kind < 0.97:
        return [extreme(rng, depth + 1) for _ in range(rng.randrange(4))]
    return {rng.choice(KEYS): extreme(rng, depth + 1) for _ in range(rng.randrange(4))}


def places(data: Any, path: tuple = ()) -> list[tuple]:
    """The paths of all values in a case."""
    found = [path] if path else []
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for name, item in items:
        found += places(item, (*path, name))
    return found


def mutated_values(rng: random.Random, text: str) -> bytes:
    """A case with up to four of its values changed, TOML still."""
    data = tomllib.loads(text)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        path = rng.choice(places(data) or [("title",)])
        owner = data
        for step in path[:-1]:
            owner = owner[step]
        name, act = path[-1], rng.random()
        old = owner[name] if not isinstance(owner, dict) else owner.get(name)
        if act < 0.45:
            owner[name] = extreme(rng)
        elif act < 0.65 and isinstance(old, int | float) and not isinstance(old, bool):
            scaled = old * rng.choice(FACTORS)
            owner[name] = int(scaled) if isinstance(old, int) and math.isfinite(scaled) else scaled
        elif act < 0.72 and isinstance(owner, dict):
            del owner[name]
        elif act < 0.8 and isinstance(owner, dict):
            owner[rng.choice([f"{name}x", f"{name}"[:-1] or "z", rng.choice(KEYS)])] = copy.deepcopy(old)
        elif act < 0.9 and isinstance(old, list) and old:
            owner[name] = [copy.deepcopy(rng.choice(old)) for _ in range(rng.choice([0, 1, 2, len(old) + 1, 50]))]
        else:
            _add_solid(rng, data)
    return tomli_w.dumps(data).encode()


def _add_solid(rng: random.Random, data: dict) -> None:
    """A structure or a body at some place, likely in the way."""
    at = [rng.uniform(-20.0, 20.0) for _ in range(3)]
    kind, sides = rng.randrange(5), [rng.uniform(0.1, 9.0), rng.choice([1e-9, 1.0, 80.0])]
    solids: list[dict] = [
        {"kind": "pile", "name": f"s{rng.randrange(9)}", "center": at[:2], "radius": rng.choice([0.1, 2.0, 30.0])},
        {"kind": "box", "name": f"s{rng.randrange(9)}", "center": at[:2], "size": sides},
        {"kind": "plane", "name": f"s{rng.randrange(9)}", "point": at, "normal": [rng.uniform(-1.0, 1.0) for _ in range(3)]},
        {"vertices": [[rng.uniform(-1.0, 1.0) for _ in range(3)] for _ in range(rng.randrange(1, 9))], "position": at},
        {"outline": [[at[0] + 2.0 * math.cos(a), at[1] + 2.0 * math.sin(a)] for a in (0.0, 1.5, 3.0, 4.5)], "thickness": 0.5},
    ]
    table = "structure" if kind < 3 else "body"
    if isinstance(data.get(table, []), list):
        data.setdefault(table, []).append(solids[kind])


def mutated_text(rng: random.Random, text: str) -> bytes:
    """The bytes of a case with pieces cut out, doubled, swapped for others or for noise."""
    content = bytearray(text.encode())
    for _ in range(rng.choice([1, 1, 2, 5])):
        place, length = rng.randrange(len(content) + 1), rng.choice([1, 1, 2, 8, 60])
        noise = [bytes([rng.randrange(256)]), b"9" * 5000, b"'''", *(bytes([byte]) for byte in b'\xff\x00\x1b"[]{}=.,\n')]
        act = rng.randrange(4)
        if act == 0:
            del content[place : place + length]
        elif act == 1:
            content[place:place] = rng.choice(noise)
        elif act == 2:
            content[place:place] = content[place : place + length]
        else:
            content[place : place + length] = rng.choice(noise)
    return bytes(content)
