"""``aionode completion``: the completion scripts of shells."""

from __future__ import annotations

import click

__all__ = ["completion_command"]

SETUP = """\
# Put the following into {file}:
#   {line}
"""
BASH = """\
_aionode_completion() {
    local IFS=$'\\n' response completion type value
    response=$(env COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD \\
        _AIONODE_COMPLETE=bash_complete "$1")
    while IFS=',' read -r type value; do
        case $type in
            dir) COMPREPLY=(); compopt -o dirnames ;;
            file) COMPREPLY=(); compopt -o default ;;
            plain)
                # YAML values are a single shell word.
                [[ $value == *[[:space:]]* ]] && value=${value@Q}
                COMPREPLY+=("$value")
                # A package name, which continues after its slash.
                [[ $value == */ ]] && compopt -o nospace ;;
        esac
    done <<< "$response"
    return 0
}
complete -o nosort -F _aionode_completion aionode
"""
ZSH = """\
#compdef aionode
_aionode_completion() {
    local -a response plain unfinished described quoted
    local type key descr
    (( ! $+commands[aionode] )) && return 1
    response=("${(@f)$(env COMP_WORDS="${words[*]}" COMP_CWORD=$((CURRENT-1)) \\
        _AIONODE_COMPLETE=zsh_complete aionode)}")
    for type key descr in ${response}; do
        case $type in
            dir) _path_files -/ ;;
            file) _path_files -f ;;
            plain)
                if [[ $descr != _ ]]; then
                    described+=("${key//:/\\\\:}:$descr")
                elif [[ $key == */ ]]; then
                    # A package name, which continues after its slash.
                    unfinished+=("$key")
                elif [[ $key == *[[:space:]]* ]]; then
                    # YAML values are a single shell word.
                    quoted+=("${(qq)key}")
                else
                    plain+=("$key")
                fi ;;
        esac
    done
    (( $#described )) && _describe -V unsorted described -U
    (( $#unfinished )) && compadd -S '' -U -V unsorted -a unfinished
    (( $#quoted )) && compadd -Q -U -V unsorted -a quoted
    (( $#plain )) && compadd -U -V unsorted -a plain
    return 0
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    _aionode_completion "$@"
else
    compdef _aionode_completion aionode
fi
"""
FISH = """\
function _aionode_completion
    set -l response (env _AIONODE_COMPLETE=fish_complete COMP_WORDS=(commandline -cp) \\
        COMP_CWORD=(commandline -t) aionode)
    for completion in $response
        # YAML values contain commas of their own.
        set -l metadata (string split -m 1 "," -- $completion)
        switch $metadata[1]
            case dir
                __fish_complete_directories $metadata[2]
            case file
                __fish_complete_path $metadata[2]
            case plain
                echo $metadata[2]
        end
    end
end
complete --no-files --command aionode --arguments "(_aionode_completion)"
"""
OWN_SCRIPTS = {"bash": BASH, "zsh": ZSH, "fish": FISH}
"""Replace click's scripts, which append a space to everything and cut values at a comma."""

SHELLS = {
    "bash": ("~/.bashrc", 'eval "$(aionode completion bash)"'),
    "zsh": ("~/.zshrc", 'eval "$(aionode completion zsh)"'),
    "fish": ("~/.config/fish/completions/aionode.fish", "aionode completion fish | source"),
}


@click.command("completion")
@click.argument("shell", type=click.Choice(list(SHELLS)))
def completion_command(shell: str) -> None:
    """Print the script that completes commands, options, types and names in SHELL."""
    file, line = SHELLS[shell]
    click.echo(SETUP.format(file=file, line=line), nl=False)
    click.echo(OWN_SCRIPTS[shell], nl=False)
