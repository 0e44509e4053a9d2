"""The table of settings: checked values, notices, and errors that say what to do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from strategies import junk, property_test, setting_values

from flowtex.settings import NEEDS, TABLE, Settings, SettingsError


def test_every_row_is_complete_and_its_default_fits() -> None:
    for row in TABLE.values():
        assert row.check(row.default) == row.default
        assert row.text.endswith(".") and len(row.text) < 110
        if row.kind in (int, float):
            assert row.low is not None and row.high is not None
            assert row.low <= row.default <= row.high
        if row.kind is str:
            assert row.default in row.choices


def test_update_sets_all_or_nothing() -> None:
    settings = Settings()
    with pytest.raises(SettingsError):
        settings.update(samples=9, contrast=-1)
    assert settings.samples == TABLE["samples"].default


def test_observers_hear_of_changes_only_and_can_leave() -> None:
    settings, heard = Settings(), []
    leave = settings.observe(lambda name, value: heard.append((name, value)))
    settings.samples = 9
    settings.samples = 9
    leave()
    leave()
    settings.samples = 11
    assert heard == [("samples", 9)]


def test_a_copy_has_the_values_and_not_the_observers() -> None:
    settings = Settings(samples=9)
    heard: list[Any] = []
    settings.observe(lambda name, value: heard.append(name))
    copy = settings.copy()
    copy.samples = 12
    assert (copy.samples, settings.samples, heard) == (12, 9, [])


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [("lod", "No", False), ("lod", " true ", True), ("samples", "25", 25), ("grain", "1e0", 1.0)],
)
def test_texts_of_people_are_read(name: str, text: str, value: object) -> None:
    assert TABLE[name].parse(text) == value


def test_panels_know_what_a_setting_needs() -> None:
    for name, conditions in NEEDS.items():
        for other, _, value in conditions:
            assert name in TABLE and TABLE[other].check(value) == value
    controls = {row.name: row.control for row in TABLE.values()}
    assert controls["lod"] == "checkbox" and controls["noise"] == "choice"
    assert controls["samples"] == "slider" and controls["seed"] == "number"
    assert TABLE["lod"].label == "Level of detail" and TABLE["speed_in"].label == "Speed in"


@property_test(60)
@given(st.data())
def test_any_value_of_a_setting_comes_back_from_its_text(data: st.DataObject) -> None:
    values = data.draw(setting_values(resolution=8192, samples=200))
    for name, value in values.items():
        row = TABLE[name]
        back = row.parse(row.format(value))
        assert back == value == getattr(Settings(**{name: value}), name)
        assert type(back) is row.kind


@property_test(60)
@given(st.sampled_from(list(TABLE)), junk() | st.just(np.ones(2)) | st.just(np.array(["box"])))
@example("samples", 10**400)
@example("kernel", np.array(["box", "hann"]))
def test_anything_is_a_value_or_is_refused_clearly(name: str, value: Any) -> None:
    row = TABLE[name]
    for take, given_ in ((row.check, value), (row.parse, str(value))):
        try:
            taken = take(given_)
        except SettingsError as error:
            assert str(error).startswith(f"{name} is ") and "; expected " in str(error)
        else:
            assert type(taken) is row.kind and row.check(taken) == taken
