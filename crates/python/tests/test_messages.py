"""Wrong input raises what the program says; what it warns of is a warning."""

import re
import warnings

import kempf
import numpy as np
import pytest
from conftest import ZIGZAG


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda path: kempf.read("no-such.csv"), "no-such.csv: there is no such file"),
        (lambda path: kempf.read(path, trial=9), "there is no manoeuvre 9"),
        (lambda path: kempf.read(path, from_s="noon"), "expected seconds, or a time such as 14:03:05"),
        (lambda path: kempf.read(path, length_m=-3, speed_kn=1), "expected a number from 0.1 to 1000"),
        (lambda path: kempf.read(path, speed_kn=15), "--length-m"),
        (lambda path: kempf.read(path, length_m=100, speed_kn=15, speed_m_s=7), "cannot be used with"),
        (lambda path: kempf.read(path.parent), "this is a folder of 2 records"),
        (lambda path: kempf.fit(path, methods="guess"), "--method guess: no such method; use all, or one of output-error"),
        (lambda path: kempf.fit(path, seed=-1), "seed = -1: expected a whole number from 0"),
        (lambda path: kempf.fit(3), "int: expected a record"),
        (lambda path: kempf.fit(path).plot("nothing"), 'expected "record" or "estimates"'),
        (lambda path: kempf.fit(path, prior="no-such.json"), "no-such.json: "),
        (lambda path: kempf.fit(path, prior=kempf.fit(path)), "fit.json: it holds no hull"),
        (lambda path: kempf.predict(kempf.fit(path), prior=kempf.fit(path)), "fit.json: it holds no hull"),
        (lambda path: kempf.trace(path, prior=[kempf.fit(path)]), "fit.json: it holds no hull"),
        (lambda path: kempf.trace(path, prior=[3]), "int: expected a result of kempf.fit or kempf.trace"),
        (lambda path: kempf.trace(path, with_="magic"), "there is no effect `magic`"),
        (lambda path: kempf.trace(path, only="wind_moment", with_="wind_moment"), "cannot be used with"),
        (lambda path: kempf.trace(path, rule="mine"), "rule"),
        (lambda path: kempf.predict("no-such.json"), "no-such.json: there is no such file"),
        (lambda path: kempf.predict(path), "this is no JSON"),
        (lambda path: kempf.predict(kempf.fit(path), draws=3), "3 is not in 50..=100000"),
        (lambda path: kempf.predict(kempf.fit(path), "loop"), "loop"),
        (lambda path: kempf.predict([3]), "int: expected a result"),
        (lambda path: kempf.simulate("no-such.toml"), "no-such.toml"),
        (lambda path: kempf.simulate(ZIGZAG.replace("T-s", "Ts")), "unknown key|`Ts`|Ts"),
        (lambda path: kempf.simulate({"question": None}), "leave out keys that are None"),
        (lambda path: kempf.simulate(ZIGZAG, replicate=3), "--replicate 3: scenario.toml has 3 trials"),
        (lambda path: kempf.simulate(ZIGZAG, cell="no"), "has no such cell"),
        (lambda path: kempf.run(ZIGZAG, "out", threads=0), "threads = 0: expected a whole number from 1 to 1024"),
        (lambda path: kempf.read(path).to_frame("excel"), 'expected "pandas" or "polars"'),
    ],
)
def test_wrong_input_is_told_as_by_the_program(call, said, first_order, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kempf.KempfError, match=said) as caught:
        call(first_order)
    assert isinstance(caught.value, ValueError) and not str(caught.value).startswith("error")
    assert "--help" not in str(caught.value), "a notebook has no command line"


def test_wrong_arrays_are_told(first_order):
    record = kempf.read(first_order)
    good = {"t_s": record.t_s, "heading_deg": record.heading_deg, "rudder_deg": record.rudder_deg}
    for change, said in [
        ({"heading_deg": record.heading_deg[:-1]}, "heading_deg has 240 values and t_s has 241"),
        ({"heading_deg": None}, "heading"),
        ({"rudder_deg": -record.rudder_deg}, "the rudder sign looks flipped"),
        ({"t_s": record.t_s[::-1]}, "record.csv"),
        ({"heading_deg": np.zeros((2, 2))}, "2 dimensions"),
        ({"name": "a<b"}, "which has no `<`"),
    ]:
        with pytest.raises(kempf.KempfError, match=re.escape(said)):
            kempf.Record.from_arrays(**{**good, **change})


def test_a_folder_that_cannot_be_made_is_work(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(kempf.WorkError, match="file"):
        kempf.run(ZIGZAG, tmp_path / "file" / "below")
    assert issubclass(kempf.WorkError, RuntimeError)


def test_warnings_are_warnings_at_the_line_that_asked(undeclared, first_order):
    for call, said in [
        (lambda: kempf.read(undeclared), "the zig-zag 20/20 from 0.0 s to 234.0 s is used"),
        (lambda: kempf.fit([first_order, first_order]), "given twice with the same content"),
        (lambda: kempf.trace(first_order, validate=first_order), "validates nothing"),
        (lambda: kempf.predict(kempf.fit(first_order)), "the answer of output-error is used"),
        (lambda: kempf.Record.from_frame(kempf.read(undeclared).to_frame(), length_m=100, ship_speed_kn=9), "zig-zag"),
    ]:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            call()
        found = [one for one in caught if said in str(one.message)]
        assert found and found[0].category is kempf.KempfWarning, said
        assert all(one.filename == __file__ for one in caught), said


def test_warnings_stay_with_the_record(undeclared):
    record = kempf.read(undeclared)
    assert len(record.warnings) == 1 and "the zig-zag 20/20" in record.warnings[0]


def test_nothing_is_printed(capfd, tmp_path, fitted, undeclared):
    kempf.trace(undeclared)
    kempf.predict(fitted, "zig-zag:10/10", draws=50)
    kempf.run(ZIGZAG, tmp_path / "out")
    assert capfd.readouterr() == ("", "")
