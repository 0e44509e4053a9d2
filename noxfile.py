#!/usr/bin/env -S uv run --script
# /// script
# dependencies = ["nox>=2025.10.14"]
# ///
"""The targets of the Makefile, for who has nox."""

from __future__ import annotations

import nox

nox.needs_version = ">=2025.10.14"
nox.options.default_venv_backend = "none"  # `make` sets up .venv


@nox.session(default=True)
def lint(session: nox.Session) -> None:
    """Judge style, format, types and the browser client."""
    session.run("make", "lint", external=True)


@nox.session(default=True)
def test(session: nox.Session) -> None:
    """Run every check and every test."""
    session.run("make", "test", f"PYTEST_ARGS={' '.join(session.posargs)}", external=True)


@nox.session(default=False)
def docs(session: nox.Session) -> None:
    """Build the site."""
    session.run("make", "site", external=True)


if __name__ == "__main__":
    nox.main()
