"""Each row of supported data is its flow in the app and in a widget, and ``info`` describes it."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import pytest
import test_forms
import test_supported
from form_table import FORMS, data_of
from known_flow import Truth, check
from supported import ROWS, Supported, shown

pytest.importorskip("pyproj")
pytest.importorskip("pyvista")
#: The modules that register forms and rows.
MODULES = (test_forms, test_supported)
#: Arguments of the app that are no part of a file.
OF_PARTS = ("vectors", "plane", "block")


@pytest.fixture
def made(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> tuple[Any, dict[str, Any], Truth]:
    """Return the data, the options and the truth of a row of supported data."""
    row: Supported = request.param
    if row.needs:
        pytest.importorskip(row.needs.replace("-", "_"))
    monkeypatch.chdir(tmp_path)
    variables, truth = row.make(tmp_path)
    return *shown(row.code, variables), truth


ALL_ROWS = pytest.mark.parametrize(
    "made", ROWS, indirect=True, ids=[row.make.__name__ for row in ROWS]
)


def files_of(data: Any) -> list[Path]:
    """Return the paths of data that are files; empty for other data."""
    items = data
    if not isinstance(data, (list, tuple)):
        items = [data]
    if all(isinstance(item, (str, Path)) for item in items):
        return list(map(Path, items))
    return []


@ALL_ROWS
def test_app_shows_the_flow(made: tuple[Any, dict[str, Any], Truth]) -> None:
    from flowtex.app.controllers.library import Choice, Library

    data, options, truth = made
    if files_of(data) and set(options) - set(OF_PARTS):
        return  # the shell reads such a file before
    chosen = {}
    for part in OF_PARTS:
        if files_of(data) and part in options:
            chosen[part] = options.pop(part)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        library = Library.of(data, **options)
        (name,) = library.names
        check(library.field(name, library.complete(name, Choice(**chosen))), truth)


@ALL_ROWS
def test_widget_shows_the_flow(made: tuple[Any, dict[str, Any], Truth]) -> None:
    pytest.importorskip("anywidget")
    from flowtex import FlowWidget

    data, options, truth = made
    arrays = (data,)
    if isinstance(data, tuple) and not files_of(data):
        arrays = data
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        widget = FlowWidget(*arrays, samples=5, **options)
        check(widget.scene.field, truth)
    widget.close()


@ALL_ROWS
def test_info_describes_the_file(
    made: tuple[Any, dict[str, Any], Truth], capsys: pytest.CaptureFixture[str]
) -> None:
    from flowtex.cli.info import info

    data, options, _ = made
    files = files_of(data)
    if not files or options:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        assert info(*files) == 0
    printed = capsys.readouterr().out
    assert "To draw it" not in printed
    assert files[0].name in printed


def test_app_shows_a_tree(tmp_path: Path) -> None:
    from flowtex.app.controllers.library import Choice, Library

    data, truth = data_of(FORMS["a_tree"], tmp_path)
    assert truth is not None
    library = Library.of(data)
    (name,) = library.names
    check(library.field(name, library.complete(name, Choice())), truth)
