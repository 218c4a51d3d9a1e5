# Completion of beamcam in bash: commands, their options and names of files, as `beamcam --help` lists them. In zsh it
# works after `autoload bashcompinit && bashcompinit`.
_beamcam() {
    if [ "$COMP_CWORD" = 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$1" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]\+\) .*/\1/p')" -- "$2")
    elif [[ $2 == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$1" "${COMP_WORDS[1]}" --help 2>/dev/null |
            grep -oE '^  (-[a-z],)?--?[a-z-]+' | tr ',' ' ')" -- "$2")
    else
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$2")
    fi
}
complete -F _beamcam beamcam
