#!/bin/sh
# locks.sh [UV]: write the oldest and the newest versions that are tried into tools/locks.
#
# pip takes them by `-c`. The oldest are the floors of pyproject.toml, for the oldest Python; the
# newest hold for every Python and system.
set -eu
cd "$(dirname "$0")/.."

uv=${1:-uv}
# An earlier lock would be kept to where it can.
rm -f tools/locks/lowest.txt tools/locks/newest.txt

lock() {
    "$uv" pip compile --quiet --no-header --no-annotate --python-version 3.11 --extra all "$@"
}

lock --resolution lowest-direct --only-binary :all: --python-platform x86_64-manylinux_2_28 \
    pyproject.toml tools/locks/tests.in -o tools/locks/lowest.txt
lock --universal --extra test --extra dev pyproject.toml -o tools/locks/newest.txt
