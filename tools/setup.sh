#!/bin/sh
# setup.sh PYTHON VENV EXTRAS [GROUP]: make the virtual environment and install flowtex into it, editable,
# with extras and a dependency group of pyproject.toml, in the versions of tools/locks/newest.txt.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

python=$1 venv=$2 extras=$3 group=${4:-}
lock=$here/locks/newest.txt

check_python() {
    command -v "$python" >/dev/null 2>&1 || fail "'$python' was not found. Install Python 3.11 or later:
  $(apt_command python3 python3-venv)
or name another interpreter: make PYTHON=/path/to/python3"
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
        fail "Python 3.11 or later is needed; '$python' is $("$python" -V 2>&1).
Name a newer one: make PYTHON=python3.12"
}

# Debian has ensurepip, which installs pip in an environment, in a separate package.
check_venv() {
    "$python" -c 'import ensurepip, venv' >/dev/null 2>&1 && return
    package=$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')
    can_install || fail "'$python' cannot make virtual environments. Install what it lacks:
  $(apt_command "$package")"
    apt_install "$package" || fail "apt-get could not install $package, which '$python' needs"
    "$python" -c 'import ensurepip, venv' || fail "'$python' still cannot make virtual environments"
}

# An environment of another Python, or one that no longer starts, is made again.
is_usable() {
    "$venv/bin/python" -m pip --version >/dev/null 2>&1 || return 1
    wanted=$("$python" -c 'import sys; print(sys.version_info[:2])')
    [ "$wanted" = "$("$venv/bin/python" -c 'import sys; print(sys.version_info[:2])')" ]
}

check_python
if ! is_usable; then
    check_venv
    say "Making $venv with $("$python" -V 2>&1)"
    "$python" -m venv --clear "$venv"
fi

pip() { "$venv/bin/python" -m pip install -qq --disable-pip-version-check --constraint "$lock" "$@"; }
# uv takes seconds where pip takes minutes.
uv() {
    pip uv && "$venv/bin/python" "$here/run_uv.py" pip install --quiet --python "$venv/bin/python" \
        --constraint "$lock" "$@"
}

say "Installing flowtex[$extras]${group:+ and the group $group} into $venv (a minute the first time)"
set -- --editable ".[$extras]" ${group:+--group "$group"}
uv "$@" || {
    say "uv failed; pip is used instead, which takes a few minutes"
    # The first pip that supports groups.
    pip "pip>=25.1"
    pip "$@"
}
