"""Run uv with the settings of pip: `python tools/run_uv.py ARGUMENT...`.

uv does not read the configuration of pip, such as a mirror, a proxy or a certificate.
"""

from __future__ import annotations

import ast
import os
import subprocess
import sys

#: Options of pip, and the variables by which uv gets the same.
VARIABLES = {
    "cert": "SSL_CERT_FILE",
    "client-cert": "SSL_CLIENT_CERT",
    "default-timeout": "UV_HTTP_TIMEOUT",
    "extra-index-url": "UV_INDEX",
    "find-links": "UV_FIND_LINKS",
    "index-url": "UV_DEFAULT_INDEX",
    "proxy": "ALL_PROXY",
    "timeout": "UV_HTTP_TIMEOUT",
    "trusted-host": "UV_INSECURE_HOST",
}


def uv_settings(listed: str) -> dict[str, str]:
    """Return what ``pip config list`` prints as variables of uv; sections prevail as in pip."""
    found: dict[str, str] = {}
    for section in ("global.", "install.", ":env:."):
        for line in listed.splitlines():
            key, _, value = line.partition("=")
            variable = VARIABLES.get(key.removeprefix(section))
            if variable and key.startswith(section):
                separator = "," if variable == "UV_FIND_LINKS" else " "
                found[variable] = separator.join(ast.literal_eval(value).split())
    if "UV_INDEX" in found:
        # pip takes the best version of all indexes, uv by itself the first index that has any.
        found["UV_INDEX_STRATEGY"] = "unsafe-best-match"
    return found


if __name__ == "__main__":
    command = [sys.executable, "-m", "pip", "config", "list"]
    listed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    command = [sys.executable, "-m", "uv", *sys.argv[1:]]
    # Variables of uv's own that are set already stay as they are.
    environment = {**uv_settings(listed), **os.environ}
    sys.exit(subprocess.run(command, env=environment, check=False).returncode)
