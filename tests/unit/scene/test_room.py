"""Fields that cannot be built are refused before a single floe is made."""

import time

import pytest

from dilatedem.case.load import case_from
from dilatedem.errors import CaseError
from dilatedem.scene import room
from dilatedem.scene.place import compose


def refused(**tables) -> str:
    began = time.process_time()
    with pytest.raises(CaseError) as caught:
        compose(case_from(tables, {}))
    assert time.process_time() - began < 2.0
    return str(caught.value)


@pytest.mark.parametrize(
    ("key", "value", "count"),
    [
        ("floe_count", 10**12, "1e+12"),
        ("floe_count", 2**63 - 1, "9.22337e+18"),
        ("floe_size", 1e-4, "1.6e+11"),
        ("floe_size", 1e-9, "1.6e+21"),
    ],
)
def test_fields_beyond_memory(key, value, count):
    message = refused(field={key: value})
    assert message.startswith(f"field.{key} = {value:g}: makes {count} floes, which take some ")
    assert message.endswith(": take larger floes, a smaller domain, or fewer floes")


def test_the_limit_is_the_memory_of_the_machine(monkeypatch):
    monkeypatch.setattr(room, "memory_of_machine", lambda: room.memory(50))
    compose(case_from({"field": {"floe_count": 50}}, {}))
    assert "there are 0.3 GB here, enough for some 50" in refused(field={"floe_count": 51})


@pytest.mark.parametrize("size", [[1000.0, 0.01], [0.01, 1000.0], [1e7, 1e-3]])
@pytest.mark.parametrize("boundary", ["open", "periodic", "wall"])
def test_domains_narrower_than_their_floes(size, boundary):
    message = refused(domain={"size": size, "x_boundary": boundary, "y_boundary": boundary}, field={"floe_count": 3})
    assert message.startswith(f"domain.size.{size.index(min(size))} = {min(size):g}: must be at least ")


def test_the_narrowest_domain_is_built_soon():
    began = time.process_time()
    compose(case_from({"domain": {"size": [16.0 * 200, 1.0]}, "field": {"floe_count": 200}, "ice": {"dilated_radius": 1e-4}}, {}))
    assert time.process_time() - began < 10.0
