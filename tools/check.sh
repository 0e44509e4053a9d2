#!/bin/sh
# check.sh BIN [PYTEST ARGUMENT...]: every check and every test, whatever the earlier ones found;
# the tests come last, so that their closing line can be seen.
set -u
here=$(dirname "$0")
. "$here/common.sh"

bin=$1
shift
failed=

# check NAME COMMAND...
check() {
    name=$1
    shift
    say "$*"
    "$bin/$@" || failed="$failed, $name"
}

check style ruff check
check format ruff format --check
check types mypy
say "javascript.sh"
sh "$here/javascript.sh" "$bin" || failed="$failed, javascript"
check tests pytest "$@"
[ -z "$failed" ] || fail "not in order: ${failed#, }"
