#!/bin/sh
# client.sh BIN [SCRIPT...]: run scripts of client/package.json; by default those that judge the browser
# client: style, types, unit tests, and whether what is kept in the package is what the sources give.
# Node comes with the environment; the tools that it runs are fetched once, without their scripts.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

PATH=$(cd "$1" && pwd):$PATH
export PATH
shift
[ $# -gt 0 ] || set -- lint test check
cd "$here/../client"

if [ ! -e node_modules/.ready ] || [ package.json -nt node_modules/.ready ]; then
    npm install --no-package-lock --ignore-scripts --no-audit --no-fund --loglevel=error
    touch node_modules/.ready
fi
for script in "$@"; do
    npm run --silent "$script"
done
[ "$*" != "lint test check" ] || say "the browser client is in order"
