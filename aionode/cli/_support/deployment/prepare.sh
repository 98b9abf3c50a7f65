# Checks that a robot can take a release, and makes its folder; changes nothing else.
# Prints "here" if the release is there already, complete.
fail() {
    echo "$1" >&2
    exit 1
}

main() {
    folder=$1 id=$2 user=$3 python=$4
    "$python" -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null ||
        fail "$python is not there, is older than 3.11, or has no venv (package python3-venv)"
    command -v systemctl >/dev/null || fail "systemctl is not there: units need systemd"
    id -u -- "$user" >/dev/null 2>&1 ||
        fail "there is no user $user, whom the unit names: add it, or change User= of the unit"
    if [ "$(id -u)" != 0 ]; then
        sudo -n true 2>/dev/null ||
            fail "sudo wants a password: let $(id -un) use it without one, or deploy as root"
    fi
    if [ ! -e "$folder" ]; then
        if [ "$(id -u)" = 0 ]; then
            mkdir -p -- "$folder"
        else
            sudo -n install -d -o "$(id -un)" -- "$folder"
        fi
    fi
    [ -w "$folder" ] || fail "$folder belongs to another user: deploy as that one"
    if [ -e "$folder/current" ] && [ ! -L "$folder/current" ]; then
        fail "$folder/current is no symbolic link, so no deployment made it: move it away"
    fi
    mkdir -p -- "$folder/releases"
    if [ -e "$folder/releases/$id/.complete" ]; then
        echo here
    fi
}

main "$@" </dev/null
