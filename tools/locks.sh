#!/bin/sh
# locks.sh [PYTHON]: write the oldest and the newest tested versions into tools/locks; PYTHON must
# have uv, such as that of `make test`.
# The oldest are the lower bounds of pyproject.toml, for the oldest Python; the newest are for every
# Python and system, and `make` installs them.
set -eu
cd "$(dirname "$0")/.."

python=${1:-.venv/bin/python}
# uv would keep the versions of an earlier lock where possible.
rm -f tools/locks/lowest.txt tools/locks/newest.txt

lock() {
    "$python" tools/run_uv.py pip compile --quiet --no-header --no-annotate --python-version 3.11 --extra all "$@"
}

lock --resolution lowest-direct --only-binary :all: --python-platform x86_64-manylinux_2_28 \
    pyproject.toml tools/locks/tests.in -o tools/locks/lowest.txt
lock --universal --group dev --group integrations --group site pyproject.toml -o tools/locks/newest.txt
