"""Files that other packages read: the message says what they are, with a line to type."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError

FORMS = Path(os.environ.get("FLOWTEX_DATA", "")) / "forms"


def message(path: Path) -> str:
    with pytest.raises(FieldError) as caught:
        FlowField.from_file(path)
    return str(caught.value)


def with_attributes(path: Path, **attributes: object) -> Path:
    with h5py.File(path, "w") as file:
        file.attrs.update(attributes)
        file["results/u"] = np.zeros((3, 4))
    return path


def test_line_of_another_package_has_the_name_of_the_file(tmp_path: Path) -> None:
    for name, line in {
        "m.ovf": 'flowtex.show(discretisedfield.Field.from_file("m.ovf").to_xarray())',
        "flow.parquet": 'flowtex.show(pandas.read_parquet("flow.parquet"))',
        "piv.mat": 'data = scipy.io.loadmat("piv.mat")',
        "photo.png": "v, u = skimage.registration.optical_flow_tvl1(first, second)",
    }.items():
        path = tmp_path / name
        path.write_bytes(b"content")
        assert line in message(path)


def test_hdf5_without_a_convention_lists_its_arrays(tmp_path: Path) -> None:
    text = message(with_attributes(tmp_path / "own.h5"))
    assert "follows no convention that is known; its arrays are results/u (3 x 4)" in text
    assert 'file = h5py.File("own.h5")' in text


def test_hdf5_of_hec_ras_names_least_squares(tmp_path: Path) -> None:
    kind = np.bytes_(b"HEC-RAS Results")
    text = message(with_attributes(tmp_path / "p01.hdf", **{"File Type": kind}))
    assert "the velocity normal to each face" in text and "numpy.linalg.lstsq(" in text


def test_hdf5_of_discretisedfield_names_its_line(tmp_path: Path) -> None:
    text = message(with_attributes(tmp_path / "m.h5", type="discretisedfield.Field"))
    assert 'flowtex.show(discretisedfield.Field.from_file("m.h5").to_xarray())' in text


def test_openpmd_names_the_vector_and_its_axes(tmp_path: Path) -> None:
    path = tmp_path / "data.h5"
    with h5py.File(path, "w") as file:
        file.attrs["openPMD"] = np.bytes_(b"1.1.0")
        record = file.create_group("data/255/fields/E")
        record.attrs["axisLabels"] = np.array([b"x", b"z"])
        record["x"] = record["z"] = np.zeros((3, 4))
    text = message(path)
    assert 'E = h5py.File("data.h5")["data/255/fields/E"]' in text
    assert '((z, x), numpy.stack([E["z"], E["x"]], axis=-1))' in text


def test_missing_xarray_selafin_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyproj")
    monkeypatch.setitem(sys.modules, "xarray_selafin", None)
    path = tmp_path / "telemac.slf"
    path.write_bytes(b"content")
    assert "needs xarray-selafin; install it with python -m pip install xarray-selafin" in message(
        path
    )


@pytest.mark.skipif(not FORMS.is_dir(), reason="FLOWTEX_DATA names no folder of real data")
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("openpmd.h5", "openPMD"),
        ("components_last.hdf5", "discretisedfield"),
        ("mumax.ovf", "discretisedfield"),
        ("hecras.p01.hdf", "HEC-RAS"),
    ],
)
def test_real_file_is_recognised(name: str, words: str) -> None:
    text = message(FORMS / name)
    assert words in text and "damaged" not in text
