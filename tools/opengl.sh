#!/bin/sh
# opengl.sh PYTHON: check that VTK can draw, and install Mesa's OpenGL if possible.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

python=$1

# Without an OpenGL library VTK ends the process, so a second one tries, which takes a second; the
# stamp keeps the result while the environment and the kind of display are the same.
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    packages='libgl1 libegl1 libgl1-mesa-dri' kind=display
else
    packages='libegl1 libgl1-mesa-dri' kind=headless
fi
stamp=$(dirname "$(dirname "$python")")/.opengl-$kind
[ -e "$stamp" ] && exit 0

# The trial alone, which does not load the package, succeeds within a second.
case $("$python" -P "$here/../flowtex/rendering/diagnostics.py" --try 2>/dev/null) in
*'"usable": true'*) touch "$stamp" && exit 0 ;;
esac

# draws: whether VTK draws; the missing packages are in $lacks. A defect of the code must not look
# like that.
draws() {
    lacks=$("$python" -c 'import sys
from flowtex.rendering import diagnostics
try:
    diagnostics.require_opengl()
except diagnostics.OpenGLMissingError as error:
    sys.exit(print(f"flowtex: {error}") or 3)') && return
    [ $? = 3 ] || fail "flowtex cannot be imported"
    return 1
}

# If another window than EGL's was requested, only what that lacks is reported.
case ${VTK_DEFAULT_OPENGL_WINDOW:-vtkEGLRenderWindow} in
*EGL*) ;;
*) can_install() { false; } ;;
esac

# shellcheck disable=SC2086 # a list of packages
draws || {
    ! can_install || apt_install $packages ||
        fail "apt-get could not install $packages, which VTK needs to draw"
    { can_install && draws; } || {
        echo "$lacks" >&2
        exit 1
    }
}
touch "$stamp"
