"""Cases that ask for bodies that bend, of which none can."""

import pytest

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.run.simulation import Simulation

SQUARE = {"outline": [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]}


@pytest.mark.parametrize("own", [{"fixed": True}, {"modes": 0}])
def test_a_case_in_which_no_body_can_bend_is_refused(own):
    case = Case.model_validate({"field": {"source": "bodies"}, "deformation": {"modes": 3}, "body": [SQUARE | own]})
    with pytest.raises(CaseError, match="no body can bend"):
        Simulation.of_case(case)
