"""A release is of one piece: versions, floors and the address agree; workflows may do little."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

import flowtex

ROOT = Path(__file__).resolve().parents[1]
PYPROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
PROJECT: dict[str, Any] = PYPROJECT["project"]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
RECIPE = ROOT / "distribution" / "conda" / "recipe.yaml"
LOCKS = ROOT / "tools" / "locks"
#: Names on conda-forge that differ by more than capital letters: its `eccodes` is the library in C,
#: its `dask` brings far more than the package.
CONDA_NAMES = {"cf-xarray": "cf_xarray", "dask": "dask-core", "eccodes": "python-eccodes"}


def read_yaml(path: Path) -> dict[Any, Any]:
    """Read a file of one mapping."""
    content = yaml.safe_load(path.read_text("utf-8"))
    assert isinstance(content, dict), path
    return content


def floors(lines: list[str]) -> dict[str, str]:
    """Return the oldest version of each library that is requested, by its small name."""
    found = [re.match(r"([\w-]+)(?:\[\w+\])? ?>=([\d.]+)", line) for line in lines]
    return {match[1].lower(): match[2] for match in found if match}


def locked(name: str) -> dict[str, list[tuple[int, ...]]]:
    """Return the versions of a lock; there are several where systems differ."""
    versions: dict[str, list[tuple[int, ...]]] = {}
    for line in (LOCKS / name).read_text("utf-8").splitlines():
        if match := re.match(r"([\w.-]+)==([\d.]+)", line):
            versions.setdefault(match[1], []).append(as_numbers(match[2]))
    return versions


def as_numbers(version: str) -> tuple[int, ...]:
    """Return a version as what can be compared, 2 being 2.0."""
    numbers = [int(number) for number in version.strip(".").split(".")]
    return tuple(numbers + [0] * (4 - len(numbers)))


def every_extra() -> list[str]:
    """What flowtex and its extras for users ask for."""
    optional: dict[str, list[str]] = PROJECT["optional-dependencies"]
    lines = [line for extra in optional.values() for line in extra]
    return [*PROJECT["dependencies"], *(line for line in lines if not line.startswith("flowtex["))]


def test_one_version_everywhere() -> None:
    assert read_yaml(ROOT / "CITATION.cff")["version"] == flowtex.__version__
    assert read_yaml(RECIPE)["context"]["version"] == flowtex.__version__
    layer = json.loads((ROOT / "distribution" / "npm" / "package.json").read_text("utf-8"))
    assert layer["version"] == flowtex.__version__
    changes = re.findall(r"^## \[(.+)\]", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert flowtex.__version__ in changes[:2]  # the first, or below what is not released


@pytest.mark.parametrize(
    "path", ["CITATION.cff", "CHANGELOG.md", "distribution/conda/recipe.yaml", "docs/conf.py"]
)
def test_the_repository_has_one_address(path: str) -> None:
    repository = PROJECT["urls"]["Repository"]
    text = (ROOT / path).read_text("utf-8")
    owner = repository.removesuffix("/flowtex")
    other = re.findall(rf"https://github\.com/[\w-]+/flowtex\b|{re.escape(owner)}/\w+", text)
    assert set(other) <= {repository}


def test_the_lowest_lock_is_of_the_floors() -> None:
    lowest = locked("lowest.txt")
    for name, floor in floors(every_extra()).items():
        asked = as_numbers(floor)
        # A floor without its last number is met by the first of its releases that has a wheel.
        assert lowest[name][0][: len(floor.split("."))] == asked[: len(floor.split("."))], name


def test_the_newest_lock_has_what_is_asked_for() -> None:
    newest = locked("newest.txt")
    groups: dict[str, list[Any]] = PYPROJECT["dependency-groups"]
    lines = [line for group in groups.values() for line in group if isinstance(line, str)]
    names = [re.match(r"[\w-]+", line) for line in lines]
    assert {match[0].lower() for match in names if match} <= newest.keys()
    for name, floor in floors([*every_extra(), *lines]).items():
        assert min(newest[name]) >= as_numbers(floor), name


def test_the_recipe_asks_for_what_the_wheel_asks_for() -> None:
    needs = read_yaml(RECIPE)["requirements"]
    run, loose = floors(needs["run"]), floors(needs["run_constraints"])
    assert PROJECT["requires-python"] == f">={read_yaml(RECIPE)['context']['python_min']}"
    wanted = {CONDA_NAMES.get(n, n): v for n, v in floors(every_extra()).items()}
    assert floors(PROJECT["dependencies"]).items() <= run.items()
    assert {**run, **loose} == wanted


def test_the_pythons_of_the_classifiers_are_tried() -> None:
    named = [c.rsplit(" ", 1)[1] for c in PROJECT["classifiers"] if re.search(r":: 3\.\d", c)]
    jobs = read_yaml(ROOT / ".github" / "workflows" / "tests.yml")["jobs"]
    assert jobs["linux"]["strategy"]["matrix"]["python"] == named


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda p: p.stem)
def test_a_workflow_may_do_nothing_but_what_its_jobs_ask_for(path: Path) -> None:
    workflow = read_yaml(path)
    assert workflow["permissions"] == {}
    for name, job in workflow["jobs"].items():
        assert job["timeout-minutes"] > 0
        writing = {k for k, v in job.get("permissions", {}).items() if v == "write"}
        assert not writing or (name in ("publish", "deploy") and "environment" in job)
        for step in job["steps"]:
            if uses := step.get("uses"):
                assert re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", uses), uses
            # What is put into a script by an expression could hold commands.
            assert "${{" not in step.get("run", "")


def test_binder_has_the_extras_that_notebooks_name() -> None:
    extras = re.compile(r"\.\[([\w,]+)\]")
    (given,) = extras.findall((ROOT / ".binder" / "postBuild").read_text("utf-8"))
    texts = [path.read_text("utf-8") for path in (ROOT / "notebooks").glob("*.ipynb")]
    named = {name for text in texts for found in extras.findall(text) for name in found.split(",")}
    assert "store" in named
    assert named <= set(given.split(","))


def test_the_container_is_not_root_and_copies_what_is_there() -> None:
    text = (ROOT / "distribution" / "Dockerfile").read_text("utf-8")
    assert re.findall(r"^USER (\S+)", text, re.MULTILINE)[-1] == "1000"
    assert '"--host", "0.0.0.0"' in text
    kept = (ROOT / "distribution" / "Dockerfile.dockerignore").read_text("utf-8")
    for name in re.findall(r"^!(\S+)$", kept, re.MULTILINE):
        assert (ROOT / name).exists(), name
    hook = PYPROJECT["tool"]["hatch"]["metadata"]["hooks"]["custom"]["path"]
    for needed in (hook, "README.md", "LICENSE", "flowtex", "shaders", "pyproject.toml"):
        assert f"!{needed}\n" in kept
