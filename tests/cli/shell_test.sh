#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What shells get from the program: help pages, a manual page made from the same texts, completion of
# commands, options and known names, and colours on terminals only.
# Usage: shell_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
has() { command -v "$1" >/dev/null; }
escape=$'\x1b'

# --- help ---
commands=$("$raymoval" --help | sed -n '/^Subcommands:/,/^$/p' | awk 'NR > 1 && NF { print $1 }')
holds "there are commands" test "$(wc -l <<<"$commands")" -ge 14
expect 0 "Subcommands:" help
holds "help is --help" diff <("$raymoval" help) <("$raymoval" --help)
for command in $commands; do
  holds "help $command is $command --help" diff <("$raymoval" help "$command") \
    <("$raymoval" "$command" --help)
done
expect 2 "Did you mean 'run'" help rnu
expect 2 "'extra' was not expected here" help run extra
expect 2 "leave 'run' out" help run --man
expect 2 "unknown option '--mann'" help --mann

# --- the manual page ---
"$raymoval" help --man >raymoval.1
if has man && has groff; then
  holds "the manual page has no mistakes" test -z \
    "$(LC_ALL=C man --warnings -l raymoval.1 2>&1 >/dev/null)"
  LC_ALL=C MANWIDTH=1000 man -l raymoval.1 >page.txt 2>/dev/null
  for command in $commands; do
    holds "it has the command $command" grep -q "raymoval $command" page.txt
    for option in $("$raymoval" "$command" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+' |
      grep -oE -- '--[a-z-]+'); do
      holds "it has $option of $command" grep -qE -- "$option( |$)" page.txt
    done
  done
  holds "it has the examples as they are typed" grep -q \
    "raymoval run suite.json --out out/suite --threads 2 --only 'town/raymoval:\*'" page.txt
else
  echo "shell_test.sh: man or groff is missing; the manual page is not looked at."
fi

# --- completion ---
expect 2 "for which shell? Name bash, zsh or fish." completion
expect 2 "'tcsh' is no shell that can be completed." completion tcsh
expect 2 "Did you mean 'zsh'" completion zhs
for shell in bash zsh fish; do
  "$raymoval" completion $shell >script.$shell
  holds "$shell: a script" test -s script.$shell
  if has $shell; then
    holds "$shell: it can be read" $shell -n script.$shell
  else
    echo "shell_test.sh: $shell is missing; its script is not read."
  fi
done

# offered LINE: what bash offers at the end of it, a word a line.
offered() (
  source ./script.bash
  COMP_LINE=$1 COMP_POINT=${#1} COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'
  _raymoval
  [[ ${#COMPREPLY[@]} -eq 0 ]] || printf '%s\n' "${COMPREPLY[@]}"
)
# offers LINE WORD...: bash offers exactly these words.
offers() {
  holds "bash: '$1' offers ${*:2}" diff <(offered "$1" | sort) <(printf '%s\n' "${@:2}" | sort)
}
holds "bash: the script is loaded" bash -c 'source ./script.bash && complete -p raymoval'
offers "raymoval re" report
offers "raymoval --v" --version
offers "raymoval clean --method raymoval:on" online
offers "raymoval run --method=raymoval_plus:offl" offline
offers "raymoval run --protocol dynamicmap-" dynamicmap-strict
offers "raymoval run --sequence cou" country
offers "raymoval run simulated-q" simulated-quick
offers "raymoval clean --method=raymoval_plus:offl" offline
offers "raymoval run --keep" --keep-removals
offers "raymoval run --set raymoval.erase_tau" raymoval.erase_tau0= raymoval.erase_tau1=
offers "raymoval run --set protocol:erasor.li" erasor.lift=
offers "raymoval run --sensor hdl" hdl32e hdl64e
offers "raymoval simulate --sensor ros" rosette
offers "raymoval simulate tow" town
offers "raymoval simulate --rolling " skewed corrected
offers "raymoval picture out --kind p" pr-rr
offers "raymoval list se" sensors sequences
offers "raymoval describe protocol:er" erasor
offers "raymoval help compa" compare
offers "raymoval completion " bash zsh fish
holds "bash: nothing is offered for a number" test -z "$(offered "raymoval run --threads ")"
holds "bash: every method and variant is offered" diff \
  <("$raymoval" list variants | awk '{ print $1 }' | grep ':' | grep -v '^external' | sort) \
  <(offered "raymoval clean --method " | grep ':.' | sort)

if has fish; then
  # What fish offers, without the sentences.
  fish_offers() {
    holds "fish: '$1' offers ${*:2}" diff <(HOME=$work fish --no-config -c \
      "source script.fish; complete -C '$1'" | cut -f1 | sort) <(printf '%s\n' "${@:2}" | sort)
  }
  fish_offers "raymoval repo" report
  fish_offers "raymoval clean --method raymoval:on" raymoval:online
  fish_offers "raymoval run --prot" --protocol
  fish_offers "raymoval list se" sensors sequences
  fish_offers "raymoval run simulated-q" simulated-quick
fi
if has zsh; then
  holds "zsh: the script is loaded" env HOME="$work" zsh -f -c \
    'autoload -U compinit && compinit -u -D && source ./script.zsh && [[ $_comps[raymoval] == _raymoval ]]'
fi

# --- colours: on a terminal that shows them and whose user wants them ---
# on_terminal COMMAND: what a terminal gets of it.
on_terminal() { TERM=${term-xterm} script -qec "$1" /dev/null </dev/null 2>&1; }
coloured() { grep -q "$escape\[[0-9;]*m" <<<"$1"; }
plain() { ! coloured "$1"; }
"$raymoval" run --sequence street --frames 0:1 --method raymoval:online --quiet --out run >out.txt
if has script; then
  unset NO_COLOR
  holds "an error is red on a terminal" coloured "$(on_terminal "'$raymoval' nonsense")"
  holds "not if NO_COLOR is set" plain "$(NO_COLOR=1 on_terminal "'$raymoval' nonsense")"
  holds "an empty NO_COLOR is none" coloured "$(NO_COLOR='' on_terminal "'$raymoval' nonsense")"
  holds "not on a dumb terminal" plain "$(term=dumb on_terminal "'$raymoval' nonsense")"
  holds "nor without TERM" plain "$(term='' on_terminal "'$raymoval' nonsense")"
  holds "not in a file that a terminal's shell writes" plain \
    "$(on_terminal "'$raymoval' nonsense 2>file.txt; cat file.txt")"
  holds "a verdict is coloured" coloured "$(on_terminal "'$raymoval' compare run run")"
  holds "not if NO_COLOR is set" plain "$(NO_COLOR=1 on_terminal "'$raymoval' compare run run")"
  holds "a verdict in a pipe is plain" plain "$(on_terminal "'$raymoval' compare run run | cat")"
  failing="'$raymoval' run --sequence street --method raymoval:online --memory-limit 1"
  holds "a failed cell is red" grep -q "$escape\[1;31m.*out_of_memory" \
    <(on_terminal "$failing --out failed")
  holds "not if NO_COLOR is set" plain "$(NO_COLOR=1 on_terminal "$failing --out failed --quiet")"
  holds "tables stay plain" plain "$(on_terminal "'$raymoval' table run")"
else
  echo "shell_test.sh: script (Debian's bsdutils) is missing; colours are not looked at."
fi
"$raymoval" nonsense >out.txt 2>err.txt
holds "an error in a file is plain" plain "$(cat err.txt)"
holds "a verdict in a pipe is plain" plain "$("$raymoval" compare run run)"
finish shell
