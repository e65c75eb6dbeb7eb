"""A law declares its own memory, and the ledger's table names what every law books."""

import numpy as np
import pytest

from benchmarks.scenes import MODELS, scene_simulation
from dilatedem.contact.laws import LAWS, law_of
from dilatedem.state.clock import Status
from dilatedem.state.ledger import COSTS, TERMS
from dilatedem.state.pairs import COLUMNS, MEMORY
from dilatedem.state.setting import CONTACT_SETTINGS


@pytest.mark.parametrize("model", MODELS)
def test_a_law_leaves_the_memory_of_others_alone(model):
    simulation = scene_simulation("packed", model)
    simulation.evaluate()
    assert simulation.advance(20) == Status.DONE
    pairs, law = simulation.state.pairs, law_of(simulation.model.contact)
    for other in set(LAWS.values()):
        for name in other.MEMORY:
            assert np.any(getattr(pairs, name)) == (other is law), name


def test_every_model_of_a_case_has_a_law_with_memory_of_its_own():
    assert set(CONTACT_SETTINGS.values()) == set(LAWS) and {model for model, _ in CONTACT_SETTINGS} == set(MODELS)
    names = [name for law in set(LAWS.values()) for name in law.MEMORY]
    assert len(set(names)) == len(names)
    assert set(names) <= {column.name for column in COLUMNS if column.group == MEMORY}


def test_the_ledger_has_the_columns_of_its_file(crowded):
    columns = (crowded / "energy.csv").read_text().split("\n", 1)[0].split(",")
    assert columns == ["time_s", *(term.name for term in TERMS if not term.optional), "residual"]
    assert {name for name in COSTS if name != "loss_crushing"} < set(columns)
