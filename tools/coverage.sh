#!/bin/sh
# coverage.sh BIN [PYTEST ARGUMENT...]: measure the coverage of flowtex/ and client/src, by lines
# and branches, into out/coverage.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"
cd "$here/.."

bin=$(cd "$1" && pwd)
shift
folder=$PWD/out/coverage
export FLOWTEX_CLIENT_COVERAGE="$folder/pages"
rm -rf "$folder"
mkdir -p "$folder/node" "$folder/pages"

say "unit tests of the browser client"
NODE_V8_COVERAGE=$folder/node sh "$here/client.sh" "$bin" test
# The committed bundles are minified; these keep the statements of the sources until the tests have
# ended.
trap 'sh "$here/client.sh" "$bin" build' EXIT
trap 'exit 130' INT TERM
sh "$here/client.sh" "$bin" plain
# Playwright's event loop excludes others, so tests with a browser run separately.
for kind in "not browser" browser; do
    PYTHONPATH=tests:${PYTHONPATH:-} "$bin/coverage" run -m pytest -p client_coverage -n "$(workers "$bin")" \
        --dist loadfile --no-loadscope-reorder -m "$kind" "$@" ||
        say "some tests failed: their coverage counts up to the failure"
done

say "flowtex/; details in $folder/html"
"$bin/coverage" combine --quiet
"$bin/coverage" html --quiet --fail-under 0 -d "$folder/html"
covered=0
"$bin/coverage" report || covered=$?
say "client/src; details in $folder/client"
sh "$here/client.sh" "$bin" coverage || covered=$?
exit $covered
