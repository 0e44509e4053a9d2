# Shared by the set-up scripts: their messages, and the installation of system packages.
# shellcheck shell=sh

say() { printf '\033[1m==>\033[0m %s\n' "$*"; }
fail() {
    printf 'flowtex: %s\n' "$*" >&2
    exit 1
}

# apt_command PACKAGE...: the command for users.
apt_command() {
    sudo=
    [ "$(id -u)" = 0 ] || sudo='sudo '
    printf '%sapt-get update && %sapt-get install --no-install-recommends %s' "$sudo" "$sudo" "$*"
}

# can_install: whether packages can be installed here without a password.
can_install() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; }

# apt_install PACKAGE...: install them; the log is shown only on failure.
apt_install() {
    say "Installing $* with apt-get (once)"
    log=$(mktemp)
    if (apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y \
        --no-install-recommends "$@") >"$log" 2>&1; then
        rm -f "$log"
    else
        tail -n 20 "$log" >&2
        rm -f "$log"
        return 1
    fi
}

# workers BIN: number of processes for the tests, one for each core: each takes five seconds to
# collect them.
workers() { "$1/python" -c 'import os; print(min(os.cpu_count() or 1, 6))'; }
