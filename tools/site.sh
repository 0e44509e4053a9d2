#!/bin/sh
# site.sh BIN: build the site into out/site and check it; all checks run even if earlier ones fail.
set -u
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh"

bin=$(cd "$1" && pwd)
root=$(dirname "$here")
site=$root/out/site
PATH=$bin:$PATH
export PATH
failed=
began=$(date +%s)
cd "$root"

# check NAME COMMAND...
check() {
    name=$1
    shift
    say "$name"
    "$@" || failed="$failed, $name"
}

# Otherwise old pages of the reference would be found again.
rm -rf docs/api out/site-words out/site-examples
mkdir -p out/site-examples
check "pages" sphinx-build -j auto -W --keep-going -q -b html -d out/site-build docs "$site"
[ -e "$site/index.html" ] || fail "the site was not built"
# Megabytes that only developers of the theme need.
find "$site" -name "*.map" -delete

if [ ! -e tools/site/node_modules/.ready ] || [ tools/site/package.json -nt tools/site/node_modules/.ready ]; then
    (cd tools/site && npm install --no-package-lock --ignore-scripts --no-audit --no-fund --loglevel=error) ||
        fail "npm could not fetch the tools of tools/site/package.json"
    touch tools/site/node_modules/.ready
fi
check "links" python tools/site/pages.py "$site" out/site-words
check "spelling" node tools/site/node_modules/cspell/bin.mjs lint --no-progress --no-gitignore \
    --show-context --config tools/site/cspell.json --root out/site-words "**/*.txt"
check "accessibility" python tools/site/accessibility.py "$site"
# The examples of docstrings write into a separate folder.
examples() {
    (cd out/site-examples && pytest -q -p no:cacheprovider -c "$root/pyproject.toml" \
        --doctest-modules --pyargs flowtex)
}
check "examples of docstrings" examples

size=$(du -sm "$site" | cut -f1)
[ "$size" -lt 60 ] || failed="$failed, size"
say "out/site: $size MB, $(find "$site" -name '*.html' | wc -l) pages, in $(($(date +%s) - began)) s"
[ -z "$failed" ] || fail "these checks failed: ${failed#, }"
