#!/bin/sh
# chromium.sh: see that there is a Chromium for the browser tests; without one they skip.
set -eu
here=$(dirname "$0")
. "$here/common.sh"

[ -z "${FLOWTEX_CHROMIUM:-}" ] || exit 0
for name in chromium chromium-browser google-chrome; do
    ! command -v "$name" >/dev/null 2>&1 || exit 0
done

# Ubuntu's package is a link to a snap, which does not start in a container.
if can_install && grep -qs '^ID=debian' /etc/os-release; then
    apt_install chromium && exit 0
fi
say "There is no Chromium: the browser tests will be skipped. To have them, install it
      ($(apt_command chromium)),
    or point FLOWTEX_CHROMIUM at another one."
