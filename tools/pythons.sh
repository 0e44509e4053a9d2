#!/bin/sh
# pythons.sh newest|oldest: print the newest or the oldest Python of this machine that flowtex supports.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

# The versions in the classifiers of pyproject.toml, in ascending order.
versions=$(sed -n 's/.*Programming Language :: Python :: \(3\.[0-9]*\)".*/\1/p' "$here/../pyproject.toml")

# works PYTHON VERSION: whether the interpreter starts, has this version, and can make environments.
works() {
    "$1" -c "import ensurepip, sys, venv; sys.exit('%d.%d' % sys.version_info[:2] != '$2')" 2>/dev/null
}

found=
for version in $versions; do
    # A shim of pyenv exists for each version, but starts only those that are selected.
    for python in "python$version" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python; do
        if works "$python" "$version"; then
            found="$found $python"
            break
        fi
    done
done
[ -n "$found" ] || fail "no Python of the versions" $versions "can make an environment"

# shellcheck disable=SC2086 # a list of interpreters
set -- $1 $found
case $1 in
oldest) echo "$2" ;;
newest) shift $(($# - 1)) && echo "$1" ;;
*) fail "'$1' is not newest or oldest" ;;
esac
