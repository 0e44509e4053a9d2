from __future__ import annotations

import runpy
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


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


def test_settings_prevail_as_in_pip(uv_settings: Callable[[str], dict[str, str]]) -> None:
    listed = """:env:.index-url='https://environment.example'
:env:.timeout='9'
global.index-url='https://file.example'
global.trusted-host='file.example'
install.index-url='https://command.example'
install.trusted-host='command.example'"""
    assert uv_settings(listed) == {
        "UV_DEFAULT_INDEX": "https://environment.example",
        "UV_HTTP_TIMEOUT": "9",
        "UV_INSECURE_HOST": "command.example",
    }


def test_nothing_is_set_for_a_plain_pip(uv_settings: Callable[[str], dict[str, str]]) -> None:
    assert uv_settings("") == {}
