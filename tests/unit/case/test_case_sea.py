"""Keys of water, wind and waves: what is wrong is said, tables come from files, cases are written and read again."""

import pytest

from dilatedem.case import write
from dilatedem.case.load import case_from, load
from dilatedem.errors import CaseError

ROWS = [[0.0, 0.1, 0.0], [10.0, 0.4, 0.2], [20.0, 0.3, 0.0]]
WAVE = {"amplitude": 0.2, "period": 5.0}


@pytest.mark.parametrize(("case", "said"), [
    ({"water": {"velocity_table": ROWS[::-1]}}, "water.velocity_table"),
    ({"water": {"velocity_table": ROWS[::-1]}}, "times must grow from row to row"),
    ({"water": {"velocity_table": [[0.0, 0.1]]}}, "water.velocity_table.0"),
    ({"water": {"velocity_table": []}}, "water.velocity_table"),
    ({"water": {"velocity_table": ROWS, "velocity": [0.3, 0.0]}},
     "water.velocity = [0.3, 0.0]: must be left out where a table says it, or be what that says at t = 0, [0.1, 0.0]"),
    ({"wind": {"velocity_file": "nowhere.csv"}}, "wind.velocity_file: nowhere.csv: no such file"),
    ({"water": {"shear": [[0.5, 1.0], [0.2, 0.5]]}}, "depths must grow from row to row"),
    ({"water": {"shear": [[-0.5, 1.0], [0.2, 0.5]]}},
     "water.shear.0.0 = -0.5: must be at least 0: depths count downwards from the surface"),
    ({"water": {"drag": "skin"}}, 'water.drag = "skin": must be "wetted" or "skin_form"; did you mean "skin_form"?'),
    ({"water": {"skin_coefficient": -1.0}}, "water.skin_coefficient = -1.0: must be at least 0"),
    ({"wave": [{"period": 5.0}]}, "wave.0.amplitude: is missing"),
    ({"wave": [WAVE | {"hight": 1.0}]}, "wave.0.hight: unknown key"),
    ({"wave": [WAVE | {"period": 0.0}]}, "wave.0.period = 0.0: must be greater than 0"),
    ({"wave": WAVE}, "wave: must be a list of tables, each under a header [[wave]]"),
    ({"wave": [WAVE, WAVE | {"amplitude": 3.0}]},
     "wave.1.amplitude = 3.0: must be at most 2.79 m: waves of that period break"),
    ({"wave": [WAVE], "water": {"enabled": False}}, ": needs water.enabled = true"),
    ({"wave": [WAVE], "gravity": {"acceleration": 0.0}}, ": needs a gravity.acceleration above 0"),
])  # fmt: skip
def test_what_is_wrong_is_said(case, said):
    with pytest.raises(CaseError) as fault:
        case_from(case, {})
    assert said in str(fault.value)


def test_a_case_is_written_with_all_of_it_and_read_again():
    case = case_from({
        "water": {"velocity_table": ROWS, "shear": [[0.0, 1.0], [1.0, 0.5]], "drag": "skin_form", "added_mass": True},
        "wind": {"velocity_table": [[0.0, 3.0, 4.0]]}, "wave": [WAVE, WAVE | {"direction": 30.0, "phase": 90.0}],
    }, {})  # fmt: skip
    assert case.water.velocity == (0.1, 0.0) and case.wind.velocity == (3.0, 4.0) and case.water.strongest == (0.4, 0.2)
    text = write.dump(case)
    assert text.count("[[wave]]\n") == 2
    assert load_text(text) == case


def load_text(text: str):
    from dilatedem.case.load import Source, build

    return build(Source("case.toml", text))


def test_a_table_comes_from_a_file_beside_the_case(tmp_path):
    (tmp_path / "current.csv").write_text("v_m_s, time_s, u_m_s\n0.0,0,0.1\n0.2,10,0.4\n")
    (tmp_path / "a.toml").write_text('[water]\nvelocity_file = "current.csv"\n')
    case = load(tmp_path / "a.toml")
    assert case.water.velocity_table == [[0.0, 0.1, 0.0], [10.0, 0.4, 0.2]]
    # the case of a run has the rows, and is repeated without the file
    (tmp_path / "current.csv").unlink()
    (tmp_path / "b.toml").write_text(write.dump(case))
    assert load(tmp_path / "b.toml") == case


@pytest.mark.parametrize(("text", "said"), [
    ("time_s,u_m_s\n0,1\n", "must begin with a line that names the columns time_s, u_m_s, v_m_s"),
    ("time_s,u_m_s,v_m_s\n0,1,0\n5,1,0\n4,1,0\n", "current.csv:4: time_s = 4 must be more than in the row before"),
    ("time_s,u_m_s,v_m_s\n", "current.csv: has no rows below the names of its columns"),
    ("time_s,u_m_s,v_m_s\n0,1,x\n", "current.csv:2: must hold a number for each of time_s, u_m_s, v_m_s"),
])  # fmt: skip
def test_a_file_that_is_no_such_table_is_named(tmp_path, text, said):
    (tmp_path / "current.csv").write_text(text)
    (tmp_path / "a.toml").write_text('[water]\nvelocity_file = "current.csv"\n')
    with pytest.raises(CaseError) as fault:
        load(tmp_path / "a.toml")
    assert "water.velocity_file: " in str(fault.value) and said in str(fault.value)


def test_a_table_on_the_command_line_takes_the_place_of_a_velocity_and_the_other_way_round(tmp_path):
    steady, told = tmp_path / "steady.toml", tmp_path / "told.toml"
    steady.write_text("[water]\nvelocity = [0.3, 0.0]\n")
    case = load(steady, ["water.velocity_table=[[0.0, 0.1, 0.0], [5.0, 0.2, 0.0]]"])
    assert case.water.velocity == (0.1, 0.0)
    told.write_text(write.dump(case))
    assert load(told, ["water.velocity=[0.6, 0.0]"]).water.velocity_table is None
    (tmp_path / "current.csv").write_text("time_s,u_m_s,v_m_s\n0,0.7,0\n")
    assert load(told, ["water.velocity_file=current.csv"]).water.velocity == (0.7, 0.0)


def test_overrides_reach_waves():
    case = case_from({"wave": [WAVE]}, {"wave.0.period": 6.0})
    assert case.wave[0].period == 6.0 and case.at_sea


def test_a_case_without_any_of_it_is_not_at_sea():
    assert not case_from({}, {}).at_sea
    assert not case_from({"wind": {"velocity": [10.0, 0.0]}, "water": {"drag": "wetted"}}, {}).at_sea
    for more in (
        {"water": {"drag": "skin_form"}}, {"water": {"added_mass": True}}, {"water": {"shear": [[0.0, 1.0]]}}, {"wave": [WAVE]},
        {"water": {"velocity_table": ROWS}}, {"wind": {"velocity_table": ROWS}},
    ):  # fmt: skip
        assert case_from(more, {}).at_sea
