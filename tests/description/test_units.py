"""Quantities at the rim: what is read, how exactly, and what is refused with which sentence."""

import math
import random
import time

import numpy as np
import pytest

from freesweep.description.units import quantity, shown


@pytest.mark.parametrize(
    ("text", "units", "expected"),
    [
        ("4.76 mm", "m", 0.00476),
        ("4.76mm", "m", 0.00476),
        ("2 in", "m", 0.0508),
        ("1 ft", "m", 0.3048),
        ("12 cm", "m", 0.12),
        ("5 µm", "m", 5e-6),
        ("5 μm", "m", 5e-6),
        ("1590 um", "m", 0.00159),
        ("0.11 MPa", "Pa", 110000.0),
        ("15 psi", "Pa", 103421.35939752542),
        ("50 kPa", "Pa", 50000.0),
        ("1.5 bar", "Pa", 150000.0),
        ("30 mbar", "Pa", 3000.0),
        ("1 atm", "Pa", 101325.0),
        ("15 psig", "Pa", 103421.35939752542),
        ("1.5 barg", "Pa", 150000.0),
        ("1.5 bar(g)", "Pa", 150000.0),
        ("50 kPa (g)", "Pa", 50000.0),
        ("15 psi gauge", "Pa", 103421.35939752542),
        ("10 inHg", "Pa", 33863.88640341),
        ("2 mH2O", "Pa", 19613.3),
        ("0.17 N/mm²", "Pa", 170000.0),
        ("0.17 N/mm^2", "Pa", 170000.0),
        ("3 lbf", "N", 13.3446648457815),
        ("2 kgf", "N", 19.6133),
        ("-5 N", "N", -5.0),
        ("−5 N", "N", -5.0),
        ("12 mNm", "N m", 0.012),
        ("1.5 N m", "N m", 1.5),
        ("1.5 N·m", "N m", 1.5),
        ("1.5 N*m", "N m", 1.5),
        ("1.5Nm", "N m", 1.5),
        ("2 lbf in", "N m", 0.2259696580552334),
        ("2 in-lbf", "N m", 0.2259696580552334),
        ("100 ozf in", "N m", 0.7061551814226044),
        ("30 deg", "degree", 30.0),
        ("30°", "degree", 30.0),
        ("-30 degrees", "degree", -30.0),
        ("0.5 rad", "degree", math.degrees(0.5)),
        ("0.5 %", "1", 0.005),
        ("1.005", "1", 1.005),
        ("1e-6", "1", 1e-6),
        (".5 mm", "m", 0.0005),
        ("+1.e3 Pa", "Pa", 1000.0),
        ("  7   mm  ", "m", 0.007),
    ],
)
def test_a_quantity_is_converted_to_the_unit_it_is_kept_in(text, units, expected):
    assert quantity(text, units) == expected


@pytest.mark.parametrize("number", [0.25, 3, np.float64(2.5), np.int64(7), "0.25"])
def test_a_plain_number_is_in_the_kept_unit_already(number):
    for units in ("m", "Pa", "N", "N m", "degree", "1"):
        result = quantity(number, units)
        assert type(result) is float
        assert result == float(number)


def test_conversion_is_decimal_so_texts_equal_the_literal_a_person_would_write():
    for thousandths in range(1, 3000):
        text = f"{thousandths / 1000:.3f}"
        assert quantity(f"{text} mm", "m") == float(f"{text}e-3")
        assert quantity(f"{text} MPa", "Pa") == float(f"{text}e6")


def test_minus_zero_is_zero():
    assert math.copysign(1.0, quantity("-0 deg", "degree")) == 1.0
    assert math.copysign(1.0, quantity(-0.0, "degree")) == 1.0


@pytest.mark.parametrize(
    ("text", "gauge"),
    [("15 psia", "14.6959 psi"), ("2 bara", "1.01325 bar"), ("2 bar(a)", "1.01325 bar"), ("15 PSIA", "14.6959 psi")],
)
def test_an_absolute_pressure_is_refused_with_the_atmosphere_to_subtract(text, gauge):
    with pytest.raises(ValueError, match="an absolute pressure; gauge pressure counts here") as caught:
        quantity(text, "Pa")
    assert f"subtract the atmosphere, {gauge} by standard" in str(caught.value)
    assert "did you mean" not in str(caught.value)


@pytest.mark.parametrize("text", ["3 ftH2O", "3 dyn", "3 inAq", "3 lbf/ft2"])
def test_a_unit_that_is_another_one_is_not_taken_for_a_slip(text):
    with pytest.raises(ValueError, match="unknown unit") as caught:
        quantity(text, "Pa")
    assert "did you mean" not in str(caught.value)


@pytest.mark.parametrize(
    ("given", "units", "says"),
    [
        ("4 mm", "Pa", "expects a pressure such as '0.1 MPa', got '4 mm', a length"),
        ("4 N", "N m", "got '4 N', a force"),
        ("4 N m", "N", "got '4 N m', a torque"),
        ("4 deg", "1", "an angle"),
        ("4 %", "m", "a number without unit"),
        ("4 furlong", "m", "unknown unit 'furlong'"),
        ("4 Mm", "m", "did you mean 'mm'"),
        ("4 PSI", "Pa", "did you mean 'psi'"),
        ("4 mPa", "Pa", "did you mean"),
        ("4 lb", "N", "did you mean 'lbf'"),
        ("4 m·m", "m", "unknown unit"),
        ("4,76 mm", "m", "decimal comma"),
        ("mm", "m", "write a number, then its unit"),
        ("", "m", "write a number"),
        ("nan", "m", "write a number"),
        ("inf m", "m", "write a number"),
        ("1e999 m", "m", "finite"),
        ("1e99999999999999999999 m", "m", "expects a length"),
        ("1e308 MPa", "Pa", "finite"),
        ("10**10**10 m", "m", "unknown unit"),
        ("1_000 mm", "m", "unknown unit"),
        ("1 000 mm", "m", "unknown unit"),
        ("0x10 mm", "m", "unknown unit"),
        ("4..5 mm", "m", "unknown unit"),
        ("__import__('os')", "m", "write a number"),
        ("٣ mm", "m", "write a number"),
        ("1" * 100_000, "m", "a text of 100000 characters; 64 are allowed"),
        (float("nan"), "m", "finite"),
        (float("-inf"), "m", "finite"),
        (10**400, "m", "more than 38 digits"),
        (True, "m", "true or false"),
        (None, "m", "nothing"),
        ([1], "m", "a list"),
        ({"a": 1}, "m", "a table"),
        (1j, "m", "type complex"),
    ],
)
def test_a_wrong_quantity_is_refused_with_what_was_found_and_what_is_allowed(given, units, says):
    with pytest.raises(ValueError, match="expects ") as caught:
        quantity(given, units)
    assert says in str(caught.value)
    assert len(str(caught.value)) < 400


def test_messages_stay_on_one_line_and_hold_no_control_characters():
    with pytest.raises(ValueError, match="unknown unit") as caught:
        quantity("4 \x1b[31m\nmm", "m")
    assert str(caught.value).isprintable()
    assert shown(10**5000) == "a whole number of more than 38 digits"
    assert len(shown("x" * 1000)) < 50


def test_junk_gives_a_finite_float_or_a_value_error_at_once():
    junk = random.Random(1)
    alphabet = "0123456789.eE+-*/ mMPaNkdegrad°µ%·in_(),\x00\nä"
    began = time.process_time()
    read = 0
    for _ in range(20_000):
        text = "".join(junk.choices(alphabet, k=junk.randrange(12)))
        try:
            assert math.isfinite(quantity(text, junk.choice(["m", "Pa", "N", "N m", "degree", "1"])))
            read += 1
        except ValueError:
            pass
    assert read > 100  # the junk does reach the reading of numbers
    assert time.process_time() - began < 20.0
