"""Text files of image velocimetry and of solvers: real files, and faults."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.sources.opening.column_names import component_names, split_unit

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

FORMS = Path(os.environ.get("FLOWTEX_DATA", "")) / "forms"
needs_data = pytest.mark.skipif(
    not FORMS.is_dir(), reason="FLOWTEX_DATA names no folder of real data"
)


def drawn_rows(field: FlowField) -> set[tuple[float, ...]]:
    """Return x, y, u and v of the valid nodes, rounded."""
    values = np.concatenate(
        [field.points[..., :2], np.asarray(field.velocity[0])[..., :2]], axis=-1
    )
    return set(map(tuple, np.round(values[field.valid], 3).tolist()))


@needs_data
def test_openpiv_text_has_the_numbers_of_the_file() -> None:
    path = FORMS / "openpiv_exp1.txt"
    table = np.loadtxt(path)
    field = FlowField.from_file(path)
    assert field.shape == (22, 30) and field.triangles is None
    assert drawn_rows(field) == set(map(tuple, np.round(table[:, :4], 3).tolist()))
    assert "columns without a header are taken as x, y, u, v, signal_to_noise" in str(field.reading)


@needs_data
def test_davis_text_has_units_and_leaves_out_zero_vectors() -> None:
    path = FORMS / "davis_B00001.txt"
    lines = path.read_text().replace(",", ".").splitlines()[1:]
    table = np.array([line.split() for line in lines], dtype=float)
    known = (table[:, 2:] != 0).any(axis=1)
    field = FlowField.from_file(path)
    assert (field.length_unit, field.velocity_unit) == ("mm", "m/s")
    assert field.shape == (64, 64)
    assert field.valid.sum() == known.sum()
    speed = np.asarray(field.speed)[..., field.valid]
    assert speed.max() == pytest.approx(np.hypot(*table[:, 2:].T).max())


def test_text_without_numbers_names_its_first_line(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("Notes of the day\n1 2 3\n")
    with pytest.raises(FieldError, match="the first one is 'Notes of the day'; expected columns"):
        FlowField.from_file(path)


def test_short_row_of_text_names_its_line(tmp_path: Path) -> None:
    path = tmp_path / "piv.txt"
    path.write_text("# x y u v\n0 0 1 1\n1 0 1 1\n0 1 1\n")
    with pytest.raises(FieldError, match=r"line 4 has 3 of 4 numbers: '0, 1, 1'"):
        FlowField.from_file(path)


def test_header_of_another_length_names_both(tmp_path: Path) -> None:
    path = tmp_path / "piv.txt"
    path.write_text("% Model: a\n% x y u\n0 0 1 1\n1 0 1 1\n")
    with pytest.raises(FieldError, match="'x y u' above the numbers names 3 columns, but each row"):
        FlowField.from_file(path)


def test_mostly_set_flags_mark_good_vectors(tmp_path: Path) -> None:
    x, y = (part.ravel() for part in np.meshgrid(np.arange(8.0), np.arange(6.0)))
    flag = np.ones(len(x))
    flag[11] = 0
    np.savetxt(tmp_path / "piv.txt", np.stack([x, y, 1 + x, y, flag], axis=-1))
    field = FlowField.from_file(tmp_path / "piv.txt")
    assert np.flatnonzero(~field.valid.ravel()).tolist() == [11]


@pytest.mark.parametrize(
    ("column", "expected"),
    [
        ("u [m/s]", ("u", "m/s")),
        ("Velocity[i] (m/s)", ("Velocity[i]", "m/s")),
        ("Velocity[i]", ("Velocity[i]", "")),
        ("X [ m ]", ("X", "m")),
        ("flux (kg/(m^2 s))", ("flux", "kg/(m^2 s)")),
        (" plain ", ("plain", "")),
    ],
)
def test_unit_in_brackets_is_split_from_the_name(column: str, expected: tuple[str, str]) -> None:
    assert split_unit(column) == expected


def test_numbers_are_components_only_with_their_siblings() -> None:
    names = [
        "Points_0",
        "Points_1",
        "Points_2",
        "U_0",
        "U_1",
        "layer_1",
        "a[i]",
        "a[j]",
        "b[i]",
        "b[j]",
        "b_x",
    ]
    changes = component_names(names)
    assert changes == {
        **{"Points_0": "x", "Points_1": "y", "Points_2": "z"},
        **{"U_0": "u", "U_1": "v", "a[i]": "a_x", "a[j]": "a_y"},
    }


def test_separated_values_without_a_header_are_read_in_their_order(tmp_path: Path) -> None:
    """As vfplot takes them: integers of the place, and two components."""
    across, up = map(np.ravel, np.meshgrid(np.arange(5), np.arange(4)))
    path = tmp_path / "grid.csv"
    np.savetxt(path, np.column_stack([across, up, 1 + up, 0.1 * across]), "%g", delimiter=", ")
    field = FlowField.from_file(path)
    assert field.shape == (4, 5)
    assert np.allclose(field.velocity[0][..., 0].ravel(), 1 + up)
    assert np.allclose(field.velocity[0][..., 1].ravel(), 0.1 * across)
    assert "columns without a header are taken as x, y, u, v" in str(field.reading)
