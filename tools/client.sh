#!/bin/sh
# client.sh BIN [ready|SCRIPT...]: run scripts of client/package.json; by default those that check
# the browser client: style, types, unit tests, and whether the bundles in the package match the
# sources. Node comes with the environment; its tools are fetched once, without their install
# scripts; "ready" does no more than that.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

PATH=$(cd "$1" && pwd):$PATH
export PATH
shift
[ $# -gt 0 ] || set -- lint test check
cd "$here/../client"
# What Node.js has compiled is kept for the next process: each file of tests is one.
NODE_COMPILE_CACHE=$PWD/node_modules/.compiled
export NODE_COMPILE_CACHE

if [ ! -e node_modules/.ready ] || [ package.json -nt node_modules/.ready ]; then
    npm install --no-package-lock --ignore-scripts --no-audit --no-fund --loglevel=error
    touch node_modules/.ready
fi
for script in "$@"; do
    [ "$script" = ready ] || npm run --silent "$script"
done
[ "$*" != "lint test check" ] || say "the browser client passed all checks"
