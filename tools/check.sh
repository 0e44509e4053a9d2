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
say "client.sh"
sh "$here/client.sh" "$bin" || failed="$failed, browser client"
# pytest says with 5 that it was asked for tests of which this half has none.
half() {
    check_name=$1
    shift
    say "$*"
    "$bin/$@"
    code=$?
    [ $code -eq 0 ] || [ $code -eq 5 ] || failed="$failed, $check_name"
}

# One more than there are cores: some tests wait for processes that they start.
workers=$("$bin/python" -c 'import os; print(min((os.cpu_count() or 1) + 1, 4))')
half tests pytest -n "$workers" --dist loadfile --no-loadscope-reorder -m "not browser" "$@"
# Tests with a browser wait for what a person would see, so few of them share the machine.
half "tests with a browser" pytest -n auto --maxprocesses 2 --dist loadfile \
    --no-loadscope-reorder -m browser "$@"
[ -z "$failed" ] || fail "not in order: ${failed#, }"
