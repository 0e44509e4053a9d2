#!/bin/sh
# check.sh BIN all|fast|changed|none [PYTEST ARGUMENT...]: style, format, types, the browser client, and tests:
# all, the fast ones, the fast ones of changed modules, or none.
# All checks run even if earlier ones fail. Long checks run in parallel with the others, and are
# reported after them.
set -u
here=$(dirname "$0")
. "$here/common.sh"

bin=$1 which=$2
shift 2
failed=
logs=$(mktemp -d)
aside=
trap 'kill $aside 2>/dev/null; rm -rf "$logs"' EXIT
trap 'exit 130' INT TERM

# check NAME COMMAND...
check() {
    name=$1
    shift
    say "$*"
    "$bin/$@" || failed="$failed, $name"
}

# Background jobs of a shell ignore Ctrl-C, which tests send to the processes that they start.
unignored='import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); os.execv(sys.argv[1], sys.argv[1:])'

# tests ARGUMENT...; pytest exits with 5 if it found none. A worker that dies ends the run: its
# replacement would begin with the same test.
tests() {
    say "pytest $*"
    "$bin/python" -c "$unignored" "$bin/pytest" --dist loadfile --no-loadscope-reorder \
        --max-worker-restart 0 "$@"
    code=$?
    [ $code -eq 0 ] || [ $code -eq 5 ]
}

# compiled: compile the tests and what they load, where that was never done. uv compiles no bytecode
# and pytest rewrites what it collects, so each worker would do so, in 14 seconds.
compiled() { [ -d "$here/../tests/__pycache__" ] || "$bin/pytest" --collect-only -qq >/dev/null 2>&1; }

# types: check types. Checkouts without a cache of their own share one, as mypy takes two minutes
# without; one process uses it at a time.
types() {
    shared=${XDG_CACHE_HOME:-$HOME/.cache}/flowtex
    if [ -d "$here/../.mypy_cache" ] || ! command -v flock >/dev/null || ! mkdir -p "$shared"; then
        "$bin/mypy"
        return
    fi
    busy=75
    flock --nonblock --conflict-exit-code $busy "$shared/mypy.lock" \
        "$bin/mypy" --cache-dir "$shared/mypy" && return
    code=$?
    [ $code -eq $busy ] || return $code
    "$bin/mypy"
}

# ended PID NAME LOG: wait for a background job, and show its output.
ended() {
    wait "$1" || failed="$failed, $2"
    say "$2"
    cat "$logs/$3"
}

sh "$here/client.sh" "$bin" ready || failed="$failed, tools of the browser client"
types >"$logs/types" 2>&1 &
types=$!
sh "$here/client.sh" "$bin" >"$logs/client" 2>&1 &
client=$!
aside="$types $client"
check style ruff check
check format ruff format --check
check imports lint-imports --no-cache
check "density of the code" python "$here/density.py"

fast="not browser and not slow"
case $which in
all | fast) compiled ;;
esac
case $which in
all)
    # Playwright's event loop excludes that of other tests, so these run in processes of their own:
    # half as many as the others, as a browser draws beside each of them.
    (tests -n "$((($(workers "$bin") + 1) / 2))" -m browser "$@") >"$logs/browser" 2>&1 &
    browser=$!
    aside="$aside $browser"
    tests -n "$(workers "$bin")" -m "not browser" "$@" || failed="$failed, tests"
    ended $browser "tests with a browser" browser
    ;;
fast) tests -n "$(workers "$bin")" -m "$fast" "$@" || failed="$failed, tests" ;;
changed)
    files=$("$bin/python" "$here/changed_tests.py") || failed="$failed, choice of tests"
    # shellcheck disable=SC2086 # a list of files
    if [ -z "$files" ]; then
        say "no tests"
    else
        tests -n "$(workers "$bin")" -m "$fast" "$@" $files || failed="$failed, tests"
    fi
    ;;
esac
ended $types types types
ended $client "browser client" client
[ -z "$failed" ] || fail "these checks failed: ${failed#, }"
