# Unpacks a release beside the others and makes its virtual environment; what runs is not touched.
# A release is complete once its file .complete is there; what is not is made anew.
main() {
    folder=$1 id=$2 python=$3
    release=$folder/releases/$id
    exec 9>"$folder/.lock"
    # One whose connection broke may still be at it.
    if command -v flock >/dev/null && ! flock -w 120 9; then
        echo "another deployment into $folder is going on" >&2
        exit 1
    fi
    if [ -e "$release/.complete" ]; then
        return
    fi
    rm -rf -- "$release"
    mkdir -- "$release"
    tar -xf "$folder/incoming.tar" -C "$release"
    "$python" -m venv "$release/.venv"
    "$release/.venv/bin/python" -m pip install --quiet --disable-pip-version-check "$release"/wheels/*.whl
    rm -f -- "$folder/incoming.tar"
    : >"$release/.complete"
}

main "$@" </dev/null
