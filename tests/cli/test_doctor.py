"""What ``flowtex doctor`` reports."""

from __future__ import annotations

import importlib.metadata

import pytest

from flowtex.cli import doctor

OK = doctor.Check("Thing", "ok", "there", "never shown")
WARN = doctor.Check("trame", "warn", "not installed", 'python -m pip install "flowtex[app]"')
FAIL = doctor.Check("OpenGL", "fail", "it [crashed]", "sudo apt-get install libegl1")


def test_the_diagnosis_covers_what_is_needed() -> None:
    checks = {check.name: check for check in doctor.diagnose()}
    assert {"Python", "OpenGL", "Display", "Shaders"} <= set(checks)
    assert {*doctor.REQUIRED, *doctor.OPTIONAL} <= set(checks)
    assert all(check.remedy for check in checks.values() if check.status != "ok")
    assert all(checks[name].status == "ok" for name in ("Python", *doctor.REQUIRED))


def test_a_missing_extra_warns_and_a_missing_requirement_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def version(name: str) -> str:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr("importlib.metadata.version", version)
    checks = {check.name: check for check in doctor.diagnose()}
    assert checks["numpy"].status == "fail"
    assert checks["numpy"].remedy == "python -m pip install numpy"
    assert checks["trame"].status == "warn"
    assert checks["trame"].remedy == 'python -m pip install -e ".[app]"'


def test_the_report_shows_every_check_and_the_remedies_that_matter(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for checks, code in (([OK, WARN], 0), ([OK, WARN, FAIL], 1)):
        monkeypatch.setattr(doctor, "diagnose", lambda checks=checks: checks)
        assert doctor.doctor() == code
    shown = capsys.readouterr().out
    for text in ("Thing", "there", "trame", "not installed", "OpenGL", "it [crashed]"):
        assert text in shown
    assert f"  {WARN.remedy}\n" in shown
    assert f"  {FAIL.remedy}\n" in shown
    assert OK.remedy not in shown
