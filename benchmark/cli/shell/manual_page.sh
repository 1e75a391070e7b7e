#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the manual page from the output of `raymoval help`.
#
#   manual_page.sh PATH/TO/raymoval >raymoval.1
set -euo pipefail
program=$1

# page [COMMAND]: a help page, with the entries of its lists as those of a manual page.
page() {
  "$program" help "$@" | awk '
    { gsub(/\\/, "\\e"); gsub(/-/, "\\-"); gsub(/`/, "\\(ga"); gsub(/\047/, "\\(aq"); gsub(/\^/, "\\(ha"); gsub(/~/, "\\(ti") }
    /^(Positionals|Options|Subcommands|[A-Z][a-z]+ options):$/ { print ".PP"; print; list = 1; next }
    /^$/ { print ".PP"; list = 0; next }
    list && /^   / { sub(/^ +/, ""); print; next }
    list {
      sub(/^ +/, "")
      at = index($0, "  ")
      print ".TP"
      if (at == 0) { print; next }
      print substr($0, 1, at - 1)
      sentence = substr($0, at); sub(/^ +/, "", sentence); print sentence
      next
    }
    { print ".br"; if (/^\./) printf "\\&"; print }'
}

echo ".TH RAYMOVAL 1 \"\" \"$("$program" --version)\" \"User Commands\""
echo '.SH NAME'
echo 'raymoval \- removes moving objects from LiDAR maps, and compares methods'
echo '.SH DESCRIPTION'
page
echo '.SH COMMANDS'
for command in $("$program" help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
  echo ".SS \"raymoval $command\""
  page "$command"
done
cat <<'END'
.SH ENVIRONMENT
.TP
.B RAYMOVAL_CACHE
Folder for simulated scenes (default: ~/.cache/raymoval).
.TP
.B NO_COLOR
If it is set and not empty, nothing is coloured. Only terminals get colours.
END
