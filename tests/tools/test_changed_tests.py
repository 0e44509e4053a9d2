from __future__ import annotations

import contextlib
import runpy
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def concerned_tests() -> Iterator[Callable[[set[str]], list[str]]]:
    """One for all, as it keeps what it has read of each file."""
    with contextlib.chdir(ROOT):
        yield runpy.run_path("tools/changed_tests.py")["concerned_tests"]


def test_a_module_concerns_its_folder_and_who_imports_it(
    concerned_tests: Callable[[set[str]], list[str]],
) -> None:
    found = concerned_tests({"flowtex/tiles/boxes.py"})
    assert {"tests/tiles", "tests/test_layers.py"} <= set(found)
    assert "tests/cli" not in found
    assert not [path for path in found if path.startswith("tests/tiles/")]
    assert "tests/test_settings.py" in concerned_tests({"flowtex/settings.py"})


def test_what_tests_share_concerns_those_that_import_it(
    concerned_tests: Callable[[set[str]], list[str]],
) -> None:
    found = concerned_tests({"tests/strategies.py"})
    assert "tests/trace/test_any_trace.py" in found
    assert "tests/test_release.py" not in found


def test_a_test_concerns_itself(concerned_tests: Callable[[set[str]], list[str]]) -> None:
    assert concerned_tests({"tests/test_camera.py"}) == ["tests/test_camera.py"]
    assert concerned_tests({"tests/test_gone.py", "CHANGELOG.md"}) == []


def test_files_beside_the_package_have_tests(
    concerned_tests: Callable[[set[str]], list[str]],
) -> None:
    assert concerned_tests({"docs/guide.md"}) == ["tests/test_docs.py"]
    assert "tests/test_release.py" in concerned_tests({".github/workflows/tests.yml"})
