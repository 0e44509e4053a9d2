#!/bin/sh
# javascript.sh BIN: judge the browser client, its style and its types.
# Node comes with the environment; the tools that it runs are fetched once, without their scripts.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

PATH=$(cd "$1" && pwd):$PATH
export PATH
cd "$here/.."
tools=tools/javascript
installed=$tools/node_modules

if [ ! -e $installed/.ready ] || [ $tools/package.json -nt $installed/.ready ]; then
    (cd $tools && npm install --no-package-lock --ignore-scripts --no-audit --no-fund \
        --loglevel=error)
    touch $installed/.ready
fi
$installed/.bin/eslint --config $tools/eslint.config.js "flowtex/**/*.js"
$installed/.bin/tsc --project $tools/tsconfig.json
say "JavaScript is in order"
