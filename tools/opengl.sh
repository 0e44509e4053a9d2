#!/bin/sh
# opengl.sh PYTHON: see that VTK can draw, and install Mesa's OpenGL where that can be done.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

python=$1

# Without an OpenGL library VTK ends the process, so a second one is asked. It costs a second;
# the stamp keeps the answer for as long as the environment and the kind of display are the same.
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    packages='libgl1 libegl1 libgl1-mesa-dri' kind=display
else
    packages='libegl1 libgl1-mesa-dri' kind=headless
fi
stamp=$(dirname "$(dirname "$python")")/.opengl-$kind
[ -e "$stamp" ] && exit 0

# The trial alone, which loads nothing of the package, says in a second that all is well.
case $("$python" -P "$here/../flowtex/diagnostics.py" --try 2>/dev/null) in
*'"usable": true'*) touch "$stamp" && exit 0 ;;
esac

# draws: whether VTK draws; what it lacks is left in $lacks. A fault of the code must not look like that.
draws() {
    lacks=$("$python" -c 'import sys
from flowtex import diagnostics
try:
    diagnostics.require_opengl()
except diagnostics.OpenGLMissingError as error:
    sys.exit(print(f"flowtex: {error}") or 3)') && return
    [ $? = 3 ] || fail "flowtex itself cannot be imported"
    return 1
}

# Whoever asked for another window than EGL's is told what it lacks, and gets nothing else.
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
