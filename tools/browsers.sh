#!/bin/sh
# browsers.sh PYTHON: install what the browser tests need; without it they are skipped.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

python=$1

has_chromium() {
    [ -z "${FLOWTEX_CHROMIUM:-}" ] || return 0
    for name in chromium chromium-browser google-chrome; do
        ! command -v "$name" >/dev/null 2>&1 || return 0
    done
    return 1
}

needed=
has_chromium || needed=chromium
# Firefox has WebGL only with a display, which may be a virtual one.
command -v firefox-esr >/dev/null 2>&1 || command -v firefox >/dev/null 2>&1 ||
    needed="$needed firefox-esr"
command -v Xvfb >/dev/null 2>&1 || needed="$needed xvfb"
# Playwright's own Node.js needs this library.
"$python" -m playwright --version >/dev/null 2>&1 || needed="$needed libatomic1"
[ -n "$needed" ] || exit 0

# Ubuntu's package is a link to a snap, which does not start in a container.
# shellcheck disable=SC2086 # a list of packages
if can_install && grep -qs '^ID=debian' /etc/os-release; then
    apt_install $needed && exit 0
fi
say "Some browser tests will be skipped. To run them, install what they need
      ($(apt_command $needed)),
    or point FLOWTEX_CHROMIUM at a Chromium of your own."
