# SPDX-License-Identifier: MIT
# Completes raymoval in bash: commands, options and known names, as the program lists them. In zsh:
# autoload -U bashcompinit && bashcompinit, before this file is sourced.
_raymoval_names() {
  "$1" list "$2" 2>/dev/null | awk '{ print $1 }'
}

_raymoval() {
  local program=$1 line=${COMP_LINE:0:COMP_POINT} words current previous names=
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=("")
  current=${words[-1]}
  previous=${words[-2]}
  if [[ ${#words[@]} -le 2 || $previous == help ]]; then
    names=$("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
  elif [[ $current == -* ]]; then
    names=$("$program" "${words[1]}" --help 2>/dev/null | grep -oE '^  (-[A-Za-z],)?--[A-Za-z-]+' | sed 's/.*--/--/')
  else
    case $previous in
      --method) names="$(_raymoval_names "$program" variants) $(_raymoval_names "$program" methods)" ;;
      describe) names="$(_raymoval_names "$program" variants) $(_raymoval_names "$program" methods)
                       $(_raymoval_names "$program" protocols | sed 's/^/protocol:/')" ;;
      --protocol) names=$(_raymoval_names "$program" protocols) ;;
      --sensor) names="$(_raymoval_names "$program" sensors) $(_raymoval_names "$program" simulated-sensors)" ;;
      --sequence | simulate | clean | inspect) names=$(_raymoval_names "$program" scenes) ;;
      run | plan) names="$(_raymoval_names "$program" suites) $(_raymoval_names "$program" scenes)" ;;
      list) names=$("$program" list | sed -n 's/^\([a-z-]*\):$/\1/p') ;;
    esac
  fi
  mapfile -t COMPREPLY < <(compgen -W "$names" -- "$current" | sort -u)
  # bash takes a word apart at its colons; what stands before the last one is taken off the names.
  if [[ $current == *:* && $COMP_WORDBREAKS == *:* ]]; then
    COMPREPLY=("${COMPREPLY[@]#"${current%"${current##*:}"}"}")
  fi
}
complete -o default -F _raymoval raymoval
