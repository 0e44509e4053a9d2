"""Where environments that were installed earlier look for PyVista's Jupyter backend."""

from __future__ import annotations

from flowtex.host.show import show_plotter as show_plotter
