"""Files for a user are written by ``flowtex/_util/whole_file.py`` alone, and temporary folders made
by ``temporary.py`` there.

The lists below are the rule: a call that could write is in one of them, with the reason, or fails.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "flowtex"
PIECES = ("_util/whole_file.py", "_util/temporary.py")

#: Calls that write wherever they stand, by the last part of their name, and those of some modules.
WRITERS = {
    *("write_text", "write_bytes", "touch", "symlink_to", "hardlink_to", "rename", "renames"),
    *("save", "savez", "savez_compressed", "savetxt", "tofile", "dump", "savefig", "imwrite"),
    *("imsave", "to_netcdf", "to_zarr", "to_csv", "to_json", "screenshot", "save_graphic"),
    *("export_html", "open_movie", "open_gif", "mkstemp", "mkdtemp", "NamedTemporaryFile"),
    *("TemporaryDirectory", "TemporaryFile", "SpooledTemporaryFile", "copyfile", "copytree"),
    *("copy2", "FileIO", "SetFileName"),
}
OF_MODULES = {"os.open", "os.replace", "shutil.copy", "shutil.move"}

#: What these write is a file of the piece, ...
WHOLE = {
    "app/controllers/sharing.py: Image.fromarray(picture).save",
    "cli/write.py: Image.fromarray(picture).save",
    "plotting/offscreen/encoders.py: av.open",
    "plotting/offscreen/encoders.py: next(pictures).save",
    "trace/slices.py: np.savez_compressed",
}
#: ... memory, ...
MEMORY = {
    "sources/datasets/align.py: array.drop_vars(clash).rename",
    "sources/opening/tables.py: array.rename",
    "sources/opening/tables.py: ds.rename",
    "sources/opening/tables.py: frame.rename",
    "plotting/offscreen/plotter.py: self._plotter.screenshot",
    "app/jupyter_backend.py: plotter.screenshot",
    "app/streaming/stream.py: Image.fromarray(pixels).save",
    "web/still.py: reduced.save",
    "widget/flow_widget.py: Image.fromarray(np.hstack(columns)).save",
    "widget/flow_widget.py: Image.fromarray(picture).save",
}
#: ... a file in a temporary folder, or one without a name, ...
TEMPORARY = {
    "app/server/files.py: path.open",
    "plotting/offscreen/encoders.py: tempfile.TemporaryFile",
}
#: ... or belongs to the system.
SYSTEM = {
    "_util/child/worker.py: Path('/proc/self/oom_score_adj').write_text",
    "_util/child/worker.py: os.open",  # the null device
}


def is_written(call: ast.Call) -> bool:
    """Return whether a call opens something in a mode that writes."""
    given = [*call.args, *(word.value for word in call.keywords if word.arg == "mode")]
    texts = [a.value for a in given if isinstance(a, ast.Constant) and isinstance(a.value, str)]
    return any(set(text) <= set("rwxabt+") and set(text) & set("wxa+") for text in texts)


def writers(path: Path, text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Call):
            continue
        name = ast.unparse(node.func)
        last = name.rsplit(".", 1)[-1]
        opens = last in ("open", "ZipFile", "TarFile") and is_written(node)
        if last in WRITERS or name in OF_MODULES or opens:
            yield f"{path.as_posix()}: {name}"


def test_files_are_written_by_one_piece() -> None:
    found = {
        call
        for path in PACKAGE.rglob("*.py")
        if (name := path.relative_to(PACKAGE)).as_posix() not in PIECES
        for call in writers(name, path.read_text(encoding="utf-8"))
    }
    assert found == WHOLE | MEMORY | TEMPORARY | SYSTEM


@pytest.mark.parametrize(
    "line",
    [
        "open(path, 'w')",
        "path.open(mode='ab')",
        "gzip.open(path, 'wt')",
        "path.write_text('x')",
        "picture.save(path)",
        "tempfile.mkdtemp()",
        "os.replace(one, other)",
        "zipfile.ZipFile(path, 'w')",
    ],
)
def test_a_call_that_writes_is_found(line: str) -> None:
    assert list(writers(Path("a.py"), line))


@pytest.mark.parametrize("line", ["open(path)", "path.open('rb')", "text.replace('a', 'b')"])
def test_a_call_that_reads_is_none(line: str) -> None:
    assert not list(writers(Path("a.py"), line))
