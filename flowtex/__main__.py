"""``python -m flowtex``, for where the script ``flowtex`` is not on the path."""

from __future__ import annotations

import sys

from flowtex.cli.commands import main

sys.exit(main())
