"""Velocities in their own unit: values times units are true."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.field import units
from flowtex.field.steps import LazySteps
from flowtex.scene.scene import Scene
from flowtex.trace.slices import typical_speed

pint = pytest.importorskip("pint")

KNOT = format(pint.UnitRegistry().knot, "~")  #: Pint 0.25 has another symbol than 0.24.

#: Solid rotation of 150 1/s: positions are in mm and velocities in m/s.
X, Y = np.meshgrid(np.linspace(-20, 20, 81), np.linspace(-10, 10, 41))
PLACES = np.stack([X, Y], axis=-1)
ROTATION = 0.15 * np.stack([-Y, X], axis=-1)


def rotation(length: str = "mm", velocity: str = "m/s", **options: Any) -> FlowField:
    options = {"length_unit": length, "velocity_unit": velocity, **options}
    return FlowField.from_arrays(PLACES, ROTATION, **options)


def test_speed_and_vorticity_are_true_in_millimetres() -> None:
    field = rotation(velocity="m s-1").with_derived("vorticity").with_derived("okubo_weiss")
    assert float(field.speed.max()) == pytest.approx(0.15 * np.hypot(20, 10))
    assert np.asarray(field.scalars["vorticity"]) == pytest.approx(300)
    assert np.asarray(field.scalars["okubo_weiss"]) == pytest.approx(-(300.0**2))
    names = ("speed", "vorticity", "okubo_weiss")
    assert [field.unit_of(name) for name in names] == ["m/s", "1/s", "1/s²"]
    # Paths are followed in the unit of the positions.
    assert np.abs(field.velocity).max() == pytest.approx(150 * 20)
    assert typical_speed(field) == pytest.approx(1000 * np.sqrt(np.mean(field.speed**2)))
    assert Scene.of(field).title_of("speed") == "speed (m/s)"
    assert Scene.of(field).scalar_limits[1] == pytest.approx(3.354, abs=1e-3)


def test_a_point_has_the_units_of_the_data() -> None:
    got = rotation().at(3.1, -2.2)
    assert got is not None
    assert got.velocity == pytest.approx([0.33, 0.465, 0])
    assert got.speed == pytest.approx(0.15 * np.hypot(3.1, 2.2))
    assert got.speed_unit == "m/s"
    assert rotation().at(20.1, 0) is None


@pytest.mark.parametrize(
    ("length", "velocity", "time", "speed_unit", "scale"),
    [
        ("m", "knots", "s", KNOT, 1852 / 3600),
        ("km", "m year-1", "yr", "m/yr", 1e-3),
        ("inch", "ft/min", "min", "ft/min", 12),
        ("degree", "degrees/s", "s", "degrees/s", 1),
        ("px", "pixel/frame", "frame", "pixel/frame", 1),
        ("mm", "cm/s", "s", "cm/s", 10),
        ("", "m s-1", "", "m/s", 1),
    ],
)
def test_velocity_is_converted_to_the_unit_of_positions(
    length: str, velocity: str, time: str, speed_unit: str, scale: float
) -> None:
    field = rotation(length, velocity)
    assert (field.time_unit, field.unit_of("speed")) == (time, speed_unit)
    assert field.speed.max() == pytest.approx(0.15 * np.hypot(20, 10))
    assert field.velocity.max() == pytest.approx(3 * scale)
    assert field.with_derived("shear").unit_of("shear") == (f"1/{time}" if time else "")


def test_lazy_steps_stay_lazy() -> None:
    read: list[int] = []

    def step(number: int) -> np.ndarray[Any, Any]:
        read.append(number)
        return ROTATION * (1 + number)

    late = LazySteps(9, step)
    field = FlowField.from_arrays(
        PLACES, late, length_unit="mm", time_unit="s", velocity_unit="m/s"
    )
    assert isinstance(field.speed, LazySteps)
    assert field.speed[4].max() == pytest.approx(5 * 0.15 * np.hypot(20, 10))
    assert set(read) == {0, 4}


@pytest.mark.parametrize(
    ("text", "usual"),
    [
        ("mb", "hPa"),
        ("hpa", "hPa"),
        ("Pascals", "Pa"),
        ("Meters", "m"),
        ("Days", "day"),
        ("ms-1", "m/s"),
        ("m.s^-1", "m/s"),
        ("cm s\u22121", "cm/s"),
        ("m s -1", "m/s"),
        ("[m/s]", "m/s"),
        ("M/S", "m/s"),
        ("KT", "knot"),
        ("kmh", "km/h"),
    ],
)
def test_usual_spellings_of_units_are_read(text: str, usual: str) -> None:
    assert units.factor(text, usual) == pytest.approx(1.0)


def test_milliseconds_stay_milliseconds() -> None:
    assert units.factor("ms", "s") == pytest.approx(1e-3)
