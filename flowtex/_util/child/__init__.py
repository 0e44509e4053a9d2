"""Work in a separate process, which may die without taking anything along."""

from __future__ import annotations

from flowtex._util.child.forkserver import FORKS
from flowtex._util.child.supervisor import ENDED, Child, ChildError, prepare

__all__ = ["ENDED", "FORKS", "Child", "ChildError", "prepare"]
