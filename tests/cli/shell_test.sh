#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What shells get: help pages, a manual page made from the same texts, completion of commands, options
# and known names in bash, and colours on terminals only.
# Usage: shell_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
shell=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../../benchmark/cli/shell")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
has() { command -v "$1" >/dev/null; }
escape=$'\x1b'

# --- help ---
commands=$("$raymoval" --help | sed -n '/^Subcommands:/,/^$/p' | awk 'NR > 1 && NF { print $1 }')
holds "there are commands" test "$(wc -l <<<"$commands")" -ge 13
expect 0 "Subcommands:" help
holds "help is --help" diff <("$raymoval" help) <("$raymoval" --help)
for command in $commands; do
  holds "help $command is $command --help" diff <("$raymoval" help "$command") \
    <("$raymoval" "$command" --help)
done
expect 2 "Did you mean 'run'" help rnu
expect 2 "'extra' was not expected here" help run extra

# --- the manual page ---
bash "$shell/manual_page.sh" "$raymoval" >raymoval.1
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
# offered LINE: the completions of bash at its end, one word per line.
offered() (
  source "$shell/raymoval.bash"
  COMP_LINE=$1 COMP_POINT=${#1} COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'
  _raymoval "$raymoval"
  [[ ${#COMPREPLY[@]} -eq 0 ]] || printf '%s\n' "${COMPREPLY[@]}"
)
# offers LINE WORD...: bash offers exactly these words.
offers() {
  holds "bash: '$1' offers ${*:2}" diff <(offered "$1" | sort) <(printf '%s\n' "${@:2}" | sort)
}
offers "raymoval re" report
offers "raymoval clean --method raymoval:on" online
offers "raymoval run --protocol dynamicmap-" dynamicmap-strict
offers "raymoval run --sequence cou" country
offers "raymoval run simulated-q" simulated-quick
offers "raymoval run --keep" --keep-removals
offers "raymoval run --sensor hdl" hdl32e hdl64e
offers "raymoval simulate --sensor ros" rosette
offers "raymoval simulate tow" town
offers "raymoval list se" sensors sequences
offers "raymoval describe protocol:er" erasor
offers "raymoval help compa" compare
holds "bash: nothing is offered for a number" test -z "$(offered "raymoval run --threads ")"
holds "bash: every method and variant is offered" diff \
  <("$raymoval" list variants | awk '{ print $1 }' | grep ':' | grep -v '^external' | sort) \
  <(offered "raymoval clean --method " | grep ':.' | grep -v '^external' | sort)

# --- colours: on a terminal that shows them and whose user wants them ---
# on_terminal COMMAND: its output on a terminal.
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
