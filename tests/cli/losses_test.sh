#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lost scans are reported on standard error, also with --quiet: scans without a pose, and scans of a
# truncated recording. So are predictions that remove no point.
# Usage: losses_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
source "$source_folder/tests/cli/checks.sh"
export RAYMOVAL_CACHE=$work/cache

# warns TEXT ARGUMENTS...: done, with one line "raymoval: warning: " and the text on standard error.
warns() {
  local text=$1
  shift
  expect 0 "" "$@"
  cp err.txt said.txt
  holds "raymoval $1 warns once of '$text'" \
    test "$(grep '^raymoval: warning: ' said.txt | grep -cF -- "$text")" -eq 1
}

# silent ARGUMENTS...: done, without a warning.
silent() {
  expect 0 "" "$@"
  cp err.txt said.txt
  holds "raymoval $1 warns of nothing" test -z "$(grep warning said.txt)"
}

# Poses that end before the scans do.
sparse_vlp16 >sparse.json
expect 0 "9 scans" simulate suburb -o drive --scans 9 --sensor sparse.json --seed 5 --quiet
paste -d' ' drive/times.txt drive/poses.txt | head -7 >drive/early.txt
early=(drive --poses early.txt)
lost="early.txt: 2 of 9 scans have no pose: 2 after the last pose. They are left out."
warns "suburb: drive/$lost" run "${early[@]}" --method noop --quiet --keep-removals --out early
warns "$lost" run "${early[@]}" --method noop --quiet --keep-removals --out early # All is kept.
warns "$lost" run "${early[@]}" --method noop --quiet --cell suburb/noop:default --out cell
warns "$lost" run "${early[@]}" --method noop --quiet --jobs 2 --out jobs
expect 0 "" run "${early[@]}" --method noop --out log
cp err.txt said.txt
holds "a log says it at the beginning, too" grep -qxF "suburb: drive/$lost" said.txt
silent run drive --method noop --quiet --keep-removals --out whole
removals=whole/cells/suburb/oracle-default/removals
silent score drive --predictions $removals --quiet
warns "suburb: drive/$lost" score "${early[@]}" --predictions $removals --quiet
warns "$lost" clean "${early[@]}" --method noop --quiet -o early.pcd
silent clean drive --method noop --quiet -o whole.pcd
expect 0 "$lost" inspect "${early[@]}" --quiet

# A scan that is cut is refused, and left out on request.
cp -r drive bad
truncate -s 1000 bad/velodyne/000004.bin
expect 2 "000004.bin: 1,000 bytes is not a multiple of 16" run bad --method noop --quiet --out bad_run
cp err.txt said.txt
holds "the remedy is named" grep -q "leave it out with --skip-bad-scans" said.txt
skipped="1 of 9 scans cannot be read (000004.bin) and are left out, as asked by --skip-bad-scans."
warns "suburb: $skipped" run bad --skip-bad-scans --method noop --quiet --out bad_run
holds "the results say so" grep -qF "$skipped" bad_run/cells/suburb/noop-default/cell.json
warns "$skipped" clean bad --skip-bad-scans --method noop --quiet -o bad.pcd

# Labels of some scans are enough.
rm bad/labels/000006.label
: >bad/labels/000007.label
partly="6 of 8 scans have labels in labels/; only these are scored."
warns "suburb: $partly" run bad --skip-bad-scans --method noop --quiet --out partly

# A recording that is cut, of which some scans are labelled.
holds "a recording is made" \
  python3 -B "$source_folder/tests/cli/recipe_data.py" drive doals recording
cp -r recording cut
truncate -s $(($(stat -c %s recording/bag.bag) * 7 / 10)) cut/bag.bag
ends="bag.bag: the file ends at byte "
warns "bag: $ends" run --sequence cut/bag.bag --protocol mos --method noop --quiet \
  --keep-removals --out cut_run
warns "bag: $ends" score cut/bag.bag --protocol mos --quiet \
  --predictions cut_run/cells/bag/oracle-default/removals
warns "recording-damaged: $ends" clean cut/bag.bag --method noop --quiet -o cut.pcd
expect 0 "" run --sequence cut/bag.bag --protocol mos --method noop --out cut_log
cp err.txt said.txt
holds "a log says which lines of indices.csv were not read" \
  grep -q "^bag: . of . scans are labelled (indices.csv).* 1 line of it" said.txt
"$raymoval" inspect cut/bag.bag --quiet >found.txt 2>err.txt
holds "inspect ends with 1" test $? -eq 1
holds "inspect finds it" grep -q "^finding recording-damaged: $ends" found.txt
expect 0 "recording-damaged: a recording is truncated or damaged, or was never closed. (clean warns)" \
  inspect --list
holds "a whole recording is not damaged" \
  test -z "$("$raymoval" inspect recording/bag.bag --quiet | grep recording-damaged)"

# Masks of 0 and 1 are no predictions.
mkdir masks
for file in $removals/*.label; do
  # The low byte of 251 and 9, as 1 and 0.
  tr '\373\011' '\001\000' <"$file" >"masks/$(basename "$file")"
done
warns "masks: no point has a label from 251 to 259, so none counts as removed; found 0, 1." \
  score drive --predictions masks --quiet

finish losses
