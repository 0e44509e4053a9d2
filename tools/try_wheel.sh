#!/bin/sh
# try_wheel.sh DIST [PYTHON]: install the wheel in DIST into a new environment, try it without the
# checkout, and run quick tests of the source archive with it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"

dist=$(cd "$1" && pwd)
python=${2:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
size=$(wc -c <"$(echo "$dist"/*.whl)")
[ "$size" -lt 3500000 ] || fail "the wheel has $size bytes; expected less than 3.5 MB"

say "A new environment, with $(basename "$dist"/*.whl) of $size bytes"
"$python" -m venv "$folder/venv"
bin=$folder/venv/bin
"$bin/pip" install --quiet --disable-pip-version-check "$(echo "$dist"/*.whl)"
cd "$folder"
unset PYTHONPATH

say "flowtex doctor"
"$bin/flowtex" doctor
"$bin/python" -P -c 'import flowtex; print(flowtex.__version__, flowtex.__file__)'
say "A picture and a page"
"$bin/python" -P -c 'import flowtex; flowtex.examples.airfoil().save("airfoil.vts")'
"$bin/flowtex" render airfoil.vts -o airfoil.png --size 400x300 --zoom 4
"$bin/flowtex" export airfoil.vts -o airfoil.html
ls -l airfoil.png airfoil.html

say "Tests of the source archive"
tar -xzf "$dist"/*.tar.gz
cd flowtex-*
"$bin/pip" install --quiet --disable-pip-version-check -r tools/locks/tests.in
# Neither the folder nor pyproject.toml puts the archive's package before the wheel.
PYTHONSAFEPATH=1 "$bin/python" -m pytest -q -n 2 --dist loadfile -o pythonpath=tests \
    -m "not browser and not slow" \
    tests/test_settings.py tests/rendering/test_camera.py tests/test_packaging.py tests/textures tests/rendering/test_vtk.py
