"""The scripts of tools/, and the targets of the Makefile."""

from __future__ import annotations

import ast
import contextlib
import pkgutil
import runpy
import shutil
import subprocess
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
    found = concerned_tests({"flowtex/textures/tiles/triangle_pyramid.py"})
    assert {"tests/textures/tiles", "tests/test_layers.py"} <= set(found)
    assert "tests/cli" not in found
    assert not [path for path in found if path.startswith("tests/textures/tiles/")]
    assert "tests/test_settings.py" in concerned_tests({"flowtex/settings.py"})


def test_a_test_concerns_itself(concerned_tests: Callable[[set[str]], list[str]]) -> None:
    assert concerned_tests({"tests/test_settings.py"}) == ["tests/test_settings.py"]
    assert concerned_tests({"tests/test_gone.py", "CHANGELOG.md"}) == []


DENSE = '''"""A module."""

def spread(a):
    """Return nothing.

    Raises
    ------
    ValueError
        Always.
    """
    # A comment.
    first, second = a, [b for b in (c for c in a)]
    raise ValueError(first if second else a if a else 0)

def narrow(faults):
    """Return nothing."""
    raise_faults(faults)

def _private():
    raise KeyError
'''


def test_density_counts_code_and_undocumented_errors(tmp_path: Path) -> None:
    (tmp_path / "dense.py").write_text(DENSE)
    (tmp_path / "_util").mkdir()
    long_body = "    a += 1\n" * 41
    (tmp_path / "_util" / "long.py").write_text(f"def f(a):\n{long_body}    raise ValueError(a)\n")
    density = runpy.run_path(str(ROOT / "tools" / "density.py"))["measure"](tmp_path)
    assert dict(density.counts) == {
        "comprehensions": 2,
        "nested comprehensions": 1,
        "conditional expressions": 2,
        "nested conditional expressions": 1,
        "parallel assignments": 1,
        "bodies over 40 lines": 1,
    }
    assert density.code == 7 + 43
    assert density.number("parallel assignments") == 1000 / 50
    assert density.raising == 2
    assert density.undocumented == [f"{tmp_path / 'dense.py'}:15 narrow"]
    faults = density.faults()
    assert faults[0].startswith("40 comprehensions; expected at most ")
    assert faults[-1].startswith("1 of 2 public functions that raise an error have no section")


@pytest.fixture(scope="module")
def uv_settings() -> Callable[[str], dict[str, str]]:
    found: Callable[[str], dict[str, str]] = runpy.run_path(str(ROOT / "tools" / "run_uv.py"))[
        "uv_settings"
    ]
    return found


def test_a_mirror_of_pip_is_one_of_uv(uv_settings: Callable[[str], dict[str, str]]) -> None:
    listed = r"""global.cert='/etc/certs/own.pem'
global.index-url='https://mirror.example/simple'
global.extra-index-url='\nhttps://one.example/simple\nfile:///two/simple'
global.find-links='/wheels /more wheels'
global.quiet='1'
freeze.index-url='https://other.example/simple'"""
    assert uv_settings(listed) == {
        "SSL_CERT_FILE": "/etc/certs/own.pem",
        "UV_DEFAULT_INDEX": "https://mirror.example/simple",
        "UV_FIND_LINKS": "/wheels,/more,wheels",
        "UV_INDEX": "https://one.example/simple file:///two/simple",
        "UV_INDEX_STRATEGY": "unsafe-best-match",
    }


@pytest.mark.parametrize("path", sorted(ROOT.glob("benchmarks/*.py")), ids=lambda path: path.stem)
def test_names_that_a_benchmark_imports_exist(path: Path) -> None:
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    names = [a.name for node in nodes if isinstance(node, ast.Import) for a in node.names]
    names += [
        f"{n.module}.{a.name}" for n in nodes if isinstance(n, ast.ImportFrom) for a in n.names
    ]
    for name in names:
        if name.startswith(("flowtex", "paper")):
            pkgutil.resolve_name(name)


@pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")
def test_help_lists_every_target() -> None:
    said = subprocess.run(["make", "help"], cwd=ROOT, capture_output=True, text=True, check=True)
    targets = (ROOT / "Makefile").read_text().split(".PHONY: ")[1].split("\n")[0].split()
    assert [name for name in targets if f"  make {name} " not in said.stdout] == []


@pytest.mark.parametrize("which", ["oldest", "newest"])
def test_pythons_names_an_interpreter_that_is_supported(which: str) -> None:
    command = ["sh", "tools/pythons.sh", which]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    question = "import sys; print(sys.version_info >= (3, 11))"
    asked = [done.stdout.strip(), "-c", question]
    answer = subprocess.run(asked, capture_output=True, text=True, check=True)
    assert answer.stdout == "True\n"
