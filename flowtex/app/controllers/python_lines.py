"""The state of a page as the lines of Python that draw it again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.links import DEFAULTS
from flowtex.app.controllers.look import COMPARISONS, PLAIN
from flowtex.app.streaming.scene import BACKGROUNDS
from flowtex.settings import TABLE

__all__ = ["to_python"]

#: Longest line.
WIDTH = 88
#: Arguments of ``FlowField.from_file``.
OF_FILE = ("vectors", "plane", "block")
#: Parts of a camera as PyVista names them.
CAMERA = ("position", "focal_point", "up", "parallel_scale", "view_angle")


def to_python(
    state: Mapping[str, Any],
    *,
    source: str | None = None,
    size: tuple[int, int] = (1024, 768),
    picture: str | None = None,
) -> str:
    """Return the lines of Python that draw a state again.

    Parameters
    ----------
    state
        What a page shows; :mod:`flowtex.app.controllers.links` has its names.
    source
        Expression that makes the field where it is not that of a file, such as
        ``"flowtex.examples.cylinder_field()"``.
    size
        Width and height of the window in pixels.
    picture
        File to write a picture to; left out, a window is opened.

    Returns
    -------
    str
        Whole lines, which run where the file is in the working folder.

    Raises
    ------
    ValueError
        When the state names no file and there is no source.
    """
    panes: list[Mapping[str, Any]] = [{}]
    if changes := COMPARISONS.get(str(state.get("split"))):
        panes.append(changes)
    window = [f"window_size={list(size)!r}"]
    window += ["off_screen=True"] if picture is not None else []
    window += ["shape=(1, 2)", "border=False"] if len(panes) > 1 else []
    lines = ["import pyvista as pv", "", "import flowtex", ""]
    lines += [f"field = {source or _from_file(state)}", _call("pl = pv.Plotter", window)]
    for column, different in enumerate(panes):
        lines += [f"pl.subplot(0, {column})"] if len(panes) > 1 else []
        lines += _added(state, different)
    lines += ["pl.link_views()", "pl.subplot(0, 0)"] if len(panes) > 1 else []
    lines += [f"pl.set_background({_text(_background(state))})", *_camera(state.get("camera"))]
    lines.append("pl.show()" if picture is None else f"pl.screenshot({_text(picture)})")
    return "\n".join(lines) + "\n"


def _from_file(state: Mapping[str, Any]) -> str:
    if not state.get("file"):
        msg = "the state names no file; give the expression that makes its field as source"
        raise ValueError(msg)
    chosen = [f"{name}={_text(state[name])}" for name in OF_FILE if state.get(name)]
    return _call("flowtex.FlowField.from_file", [_text(state["file"]), *chosen])


def _text(value: Any) -> str:
    """Return a value as people write it: with double quotes."""
    text = repr(value)
    plain = isinstance(value, str) and text[0] == "'" and '"' not in text and "\\" not in text
    return f'"{text[1:-1]}"' if plain else text


def _call(function: str, arguments: list[str]) -> str:
    """Return a call on one line, or with a line for each argument where it is long."""
    line = f"{function}({', '.join(arguments)})"
    if len(line) <= WIDTH:
        return line
    return "\n".join([f"{function}(", *(f"    {argument}," for argument in arguments), ")"])


def _added(state: Mapping[str, Any], different: Mapping[str, Any]) -> list[str]:
    """Add the flow to a view, with the settings that are not as by default."""
    colour = state.get("colour", DEFAULTS["colour"])
    look = {"scalars": False if colour == PLAIN else colour}
    if colour != PLAIN:
        look |= {name: state[name] for name in ("cmap", "clim") if state.get(name)}
    settings = {**(state.get("settings") or {}), **different}
    if settings.get("noise") == "image":  # which is a person's own, and not in the state
        del settings["noise"]
    changed = {k: v for k, v in settings.items() if v != TABLE[k].default}
    arguments = [f"{name}={_text(value)}" for name, value in {**look, **changed}.items()]
    lines = [_call("handle = pl.flowtex.add", ["field", *arguments])]
    moments = [(name, state.get(name)) for name in ("time", "clock")]
    shown = [(n, v) for n, v in moments if v is not None and v != DEFAULTS.get(n)]
    return lines + [f"handle.{name} = {value!r}" for name, value in shown]


def _background(state: Mapping[str, Any]) -> str:
    chosen = str(state.get("background", DEFAULTS["background"]))
    theme = str(state.get("theme", DEFAULTS["theme"]))
    return BACKGROUNDS[theme] if chosen == DEFAULTS["background"] else chosen


def _camera(camera: Mapping[str, Any] | None) -> list[str]:
    if not camera:
        return []
    lines = [f"pl.camera.parallel_projection = {bool(camera['parallel'])!r}"]
    for part in CAMERA:
        value = camera[part]
        plain = float(value) if isinstance(value, (int, float)) else tuple(map(float, value))
        lines.append(f"pl.camera.{part} = {plain!r}")
    return lines
