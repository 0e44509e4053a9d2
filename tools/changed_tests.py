"""Print the test files that concern what was changed: `python tools/changed_tests.py [BASE]`.

A change is what differs from BASE (by default from where the branch left main), and what git does
not know yet. A changed module concerns the tests of its folder in tests/, and those that import it.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

#: Test files, and the folders and files outside their own package that they judge.
JUDGED = {
    "tests/client": ("client/src/", "flowtex/host/"),
    "tests/host": ("flowtex/host/",),
    "tests/paper": ("paper/",),
    "tests/rendering/test_shaders.py": ("shaders/",),
    "tests/test_docs.py": ("docs/", "CONTRIBUTING.md", "README.md"),
    "tests/test_layers.py": ("flowtex/",),
    "tests/test_packaging.py": ("distribution/", "pyproject.toml", "shaders/"),
    "tests/test_release.py": (".binder/", ".github/", "distribution/", "pyproject.toml", "tools/"),
    "tests/tools": ("tools/",),
}


def git(*arguments: str) -> list[str]:
    """Return the lines that git answers, none where it fails."""
    done = subprocess.run(["git", *arguments], capture_output=True, text=True, check=False)
    return done.stdout.splitlines() if done.returncode == 0 else []


def changed_files(base: str | None) -> set[str]:
    """Return the paths that differ from the base, and new ones."""
    start = [base] if base else git("merge-base", "HEAD", "main") or ["HEAD"]
    new = git("ls-files", "--others", "--exclude-standard")
    return {*git("diff", "--name-only", *start), *new}


def module_name(path: str) -> str:
    """Return the name by which a file is imported; tests are imported by their own names."""
    return (
        path.removeprefix("tests/").removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    )


@cache
def imported_modules(path: Path) -> set[str]:
    """Return what a file imports anywhere; ``from a import b`` may mean the module ``a.b``."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.update({node.module, *(f"{node.module}.{name.name}" for name in node.names)})
    return found


def concerned_tests(changed: set[str]) -> list[str]:
    """Return the test files and folders to run for changed paths."""
    modules = {module_name(path) for path in changed if path.endswith(".py")}
    chosen = {test for test, judged in JUDGED.items() if any(p.startswith(judged) for p in changed)}
    for path in changed:
        folder = Path("tests", *Path(path).parts[1:-1])
        if path.startswith("flowtex/") and folder != Path("tests") and folder.is_dir():
            chosen.add(folder.as_posix())
        elif path.startswith("tests/") and path.endswith("conftest.py"):
            chosen.add(Path(path).parent.as_posix())
    for test in Path("tests").rglob("test_*.py"):
        if test.as_posix() in changed or imported_modules(test) & modules:
            chosen.add(test.as_posix())
    known = [Path(test) for test in chosen if Path(test).exists()]
    # A file within a folder that is chosen would be run twice.
    return sorted(str(p) for p in known if not any(other in p.parents for other in known))


if __name__ == "__main__":
    found = concerned_tests(changed_files(sys.argv[1] if len(sys.argv) > 1 else None))
    sys.stdout.writelines(f"{path}\n" for path in found)
