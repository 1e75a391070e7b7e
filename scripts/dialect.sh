#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints lines of pages and comments that are likely to be unclear: a pronoun in place of a noun
# ("those that", "what is told"), something that is alive ("a scan says"), or a rare phrase. Read each
# line again: some are right as they are. The exit code is 0.
#
#   scripts/dialect.sh [FILE...]     default: all tracked Markdown, C++, Python and shell files
#
# In source files only comments are read.
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) echo "dialect.sh: '$1' is unknown; expected files or nothing." >&2; exit 2 ;;
esac
files=("$@")
if [[ $# -eq 0 ]]; then
  cd "$(dirname "${BASH_SOURCE[0]}")/.."
  mapfile -t files < <(git ls-files '*.md' '*.h' '*.cpp' '*.py' '*.sh')
fi
for file in "${files[@]}"; do
  [[ -f $file && -r $file ]] || { echo "dialect.sh: $file: no such file; expected text files." >&2; exit 2; }
done

# One Perl expression a line, found in any case and between word boundaries.
patterns='
(those|these|that|the one|all) (that|which|who|of which)
(those|these) (with|without|who)
what (stands|lies|comes|goes|moves|follows|it|they|is told|is said|is asked|is there)
(of|for|with|without|by|from|in|to) (what|whom)
who(ever|m)?
(whatever|wherever|whichever)
(is|are|was|were) (told|said|heard|asked|meant)
(scan|voxel|point|cell|map|beam|ray|cluster|track|method|file|image|label)s? (says?|tells?|knows?|asks?|hears?|wants?|agrees?)
(tells?|knows?|asks?|hears?|wants?|answers for)
ha(s|ve|d) to be
had better
(as it is|as they are|so many|so much|so far|all the same|nothing but|but for|be it)
(anyway|anew|beforehand|likewise|besides|therein|thereby)
(stands?|stood|goes on|goes|had been)
looked (at|for)
a (row|line|bit|point|scan|pixel|voxel|second|turn) (a|an|each)
(has|have) a say
the own
'
expression=$(paste -sd'|' < <(sed '/^$/d' <<<"$patterns"))
# For each kind of file: what precedes the words to look at.
for file in "${files[@]}"; do
  case $file in
    *.h | *.cpp) before='//.*' ;;
    *.py | *.sh) before='^[^"'\'']*#.*' ;;
    *) before='^(?!    ).*' ;;  # Not blocks of code.
  esac
  grep -HniP -- "$before\b($expression)\b" "$file" || true
done
