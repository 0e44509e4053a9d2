"""A few bytes of text with the name of a mesh end no process, whatever reads that format."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pyvista")

from flowtex import FlowField
from flowtex._util.child.child import FORKS

#: Opens files of every suffix that PyVista knows in a fork, and prints those that end it; another
#: fork goes on with the next one.
SCRIPT = """
import os, sys, warnings
from pathlib import Path
from pyvista.core.utilities.reader import CLASS_READERS
from flowtex import FlowField
from flowtex.errors import FieldError

warnings.simplefilter("ignore")
folder = Path(sys.argv[1])
suffixes = sorted(CLASS_READERS)

def read(suffix):
    path = folder / f"file{suffix}"
    path.write_text(sys.argv[2])
    try:
        FlowField.from_file(path)
    except (FieldError, ModuleNotFoundError):
        return
    os._exit(1)

def read_all(told):
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    for suffix in suffixes:
        read(suffix)
        os.write(told, b".")
    os._exit(0)

while suffixes:
    told, tells = os.pipe()
    number = os.fork()
    if number == 0:
        try:
            read_all(tells)
        finally:
            os._exit(1)
    os.close(tells)
    with open(told, "rb") as file:
        done = len(file.read())
    _, status = os.waitpid(number, 0)
    if status:
        print(suffixes[done], os.waitstatus_to_exitcode(status), flush=True)
    suffixes = suffixes[done + 1 :]
"""
#: A quadrilateral with a velocity at its corners, as AVS UCD.
PLATE = """4 1 3 0 0
1 0 0 0
2 2 0 0
3 2 1 0
4 0 1 0
1 1 quad 1 2 3 4
1 3
velocity, m/s
1 1.0 0.5 0.0
2 1.5 0.5 0.0
3 2.0 0.5 0.0
4 2.5 0.5 0.0
"""


@pytest.mark.skipif(not FORKS, reason="each file is opened in a fork")
def test_text_with_the_name_of_a_mesh_ends_no_process(tmp_path: Path) -> None:
    command = [sys.executable, "-c", SCRIPT, str(tmp_path), "abc"]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert result.stdout == ""


def test_a_mesh_of_such_a_format_is_read(tmp_path: Path) -> None:
    path = tmp_path / "plate.inp"
    path.write_text(PLATE)
    field = FlowField.from_file(path)
    corners = {(x, y) for x, y, _ in np.round(field.points[0], 6).reshape(-1, 3).tolist()}
    assert corners == {(0, 0), (2, 0), (2, 1), (0, 1)}
    for x, y, u in ((0, 0, 1.0), (2, 0, 1.5), (2, 1, 2.0), (0, 1, 2.5)):
        point = field.at(x, y)
        assert point is not None
        assert point.speed == pytest.approx(np.hypot(u, 0.5), rel=1e-6)
