"""Files of other programs: each error names the program and the remedy."""

from __future__ import annotations

import os
from pathlib import Path

import h5py
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError

FORMS = Path(os.environ.get("FLOWTEX_DATA", "")) / "forms"


@pytest.mark.skipif(not FORMS.is_dir(), reason="FLOWTEX_DATA names no folder of real data")
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("telemac.slf", "xarray-selafin"),
        ("mumax.ovf", "discretisedfield"),
        ("components_last.hdf5", "discretisedfield"),
        ("hecras.p01.hdf", "normal to each face.*least squares"),
        ("openpmd.h5", "openPMD.*OpenPMDTimeSeries"),
    ],
)
def test_real_files_name_the_remedy(
    name: str, words: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(FieldError, match=f"{name}: this is .*{words}"):
        FlowField.from_file(FORMS / name)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("run.slf", b"\0\0\0\x50", "TELEMAC"),
        ("m000001", b"# OOMMF OVF 2.0\n", "micromagnetics"),
    ],
)
def test_names_and_beginnings(tmp_path: Path, name: str, content: bytes, words: str) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(FieldError, match=f"{name}: this is .*{words}"):
        FlowField.from_file(path)


@pytest.mark.parametrize(
    ("attribute", "value", "words"),
    [("File Type", b"HEC-RAS Results", "HEC-RAS"), ("openPMD", "1.1.0", "openPMD")],
)
def test_attributes_of_hdf5(tmp_path: Path, attribute: str, value: object, words: str) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.attrs[attribute] = value
    with pytest.raises(FieldError, match=f"run.h5: this is a file of {words}"):
        FlowField.from_file(path)
