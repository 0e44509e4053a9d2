"""What people see in Firefox: the page, and an exported page, which draws as the widget does."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from firefox import Firefox, firefox
from served import start

import flowtex
from flowtex._util.array_types import Bytes

pytestmark = [pytest.mark.slow, pytest.mark.browser]

SHARP = "() => document.querySelector('.flowtex[data-sharp=\"true\"]')?.clientWidth"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Firefox]:
    """Yield the one page of a Firefox."""
    with firefox(tmp_path_factory.mktemp("firefox")) as opened:
        yield opened


def is_textured(pixels: Bytes) -> bool:
    """Whether a good part of the picture changes from pixel to pixel, in many colours."""
    grey = pixels.astype(float).mean(axis=-1)
    changes = np.abs(np.diff(grey, axis=0))[:, 1:] + np.abs(np.diff(grey, axis=1))[1:]
    colours = np.unique(pixels.astype(int) @ [1, 256, 65536])
    return bool((changes > 10).mean() > 0.1 and len(colours) > 999)


@pytest.mark.usefixtures("quick_export")
def test_an_exported_page_draws(page: Firefox, tmp_path: Path) -> None:
    file = tmp_path / "gyre.html"
    flowtex.export(flowtex.examples.double_gyre(), file, samples=9)
    page.goto(file.as_uri())
    page.wait_for_function(SHARP)
    assert is_textured(page.screenshot())


def test_the_page_draws(page: Firefox) -> None:
    served = start("demo", "--example", "double_gyre", "--samples", "9")
    try:
        page.goto(served.address)
        page.wait_for_function(SHARP)
        assert is_textured(page.screenshot())
    finally:
        served.end(signal.SIGINT)
