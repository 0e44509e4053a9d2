"""The notebook widget: a flow drawn by the browser itself, in a cell.

::

    browser    client.js  <--- traits: header, settings, camera, time, clock
                   |      <--- messages with arrays: surface, slices, scalars
                   +---------> "ready", "need" a step, clicks, its first sharp frame
    kernel     FlowWidget ---> Scene, settings
                   +---------> Feed: one thread that traces, packs and sends

Nothing is drawn in the kernel but a small picture for where widgets cannot be shown.
"""

from __future__ import annotations

from flowtex.errors import install_extra

try:
    from flowtex.widget.flow_widget import FlowWidget
except ModuleNotFoundError as error:
    name = (error.name or "").split(".")[0]
    if name not in ("anywidget", "ipywidgets", "traitlets", "IPython"):
        raise
    missing = (
        f"the notebook widget needs {name}, which is not installed. To install it:\n  "
        f"{install_extra('notebook')}"
    )
    raise ModuleNotFoundError(missing, name=name) from error

__all__ = ["FlowWidget"]
