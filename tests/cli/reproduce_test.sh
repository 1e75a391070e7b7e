#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/reproduce.sh says which files of SemanticKITTI are missing before it does anything else;
# with --quick it ends with a table and a page.
# Usage: reproduce_test.sh PATH/TO/raymoval
set -uo pipefail
program=$(readlink -f "$1")
scripts=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../../scripts")
raymoval=$scripts/reproduce.sh
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

# says CODE TEXT ARGUMENTS...: as `expect`, for the script.
says() {
  checks=$((checks + 1))
  "$raymoval" "${@:3}" >out.txt 2>err.txt
  local got=$?
  [[ $got -eq $1 ]] && grep -qF -- "$2" out.txt err.txt ||
    complain "reproduce.sh ${*:3}: exit code $got, expected $1 and '$2'"
}

says 2 "say where the data is" semantickitti
says 2 "'kitti' is unknown" kitti
says 2 "missing: $work/root/sequences/00/ (sequence 00, frames 4390 to 4530)" semantickitti root --check
for segment in "00 4390 4530 2" "01 150 250 1" "02 860 950 2" "05 2350 2670 2" "07 630 820 2"; do
  read -r sequence first last stride <<<"$segment"
  mkdir -p root/sequences/"$sequence"/{velodyne,labels}
  for frame in $(seq -f %06g "$first" "$stride" "$last"); do
    echo x >root/sequences/"$sequence"/velodyne/"$frame".bin
    echo x >root/sequences/"$sequence"/labels/"$frame".label
  done
  echo x >root/sequences/"$sequence"/poses.txt
  echo x >root/sequences/"$sequence"/calib.txt
done
says 0 "sequence 07, frames 630:820:2: all there" semantickitti root --check
rm root/sequences/02/velodyne/000950.bin root/sequences/07/poses.txt
: >root/sequences/05/labels/002350.label
rm root/sequences/05/labels/002670.label
says 2 "missing: $work/root/sequences/02/velodyne/000950.bin" semantickitti root --check
says 2 "sequence 00, frames 4390:4530:2: all there" semantickitti root --check
says 2 "missing: $work/root/sequences/07/poses.txt" semantickitti root --check
says 2 "002350.label and 1 more of labels/ up to frame 2670" semantickitti root
says 2 "SemanticKITTI label data" semantickitti root

# --quick, in a copy where nothing is installed or built, and whose program makes the scene shorter.
says 2 "'now' is unknown" --quick now
says 2 "'--quik' is unknown; expected nothing, --quick, or semantickitti ROOT" --quik
mkdir -p copy/scripts copy/build/release stubs
cp "$scripts/reproduce.sh" copy/scripts/
printf '#!/usr/bin/env bash\n' >copy/scripts/install_dependencies.sh
printf '#!/usr/bin/env bash\necho "$*" >>"%s/built.txt"\n' "$work" >stubs/cmake
cat >copy/build/release/raymoval <<STUB
#!/usr/bin/env bash
echo "\$*" >>"$work/asked.txt"
exec "$program" "\${@/#town:scans=*/town:scans=4}"
STUB
chmod +x copy/scripts/* stubs/cmake copy/build/release/raymoval
raymoval=$work/copy/scripts/reproduce.sh
export RAYMOVAL_CACHE=$work/cache RAYMOVAL_OUT=$work/first
PATH=$work/stubs:$PATH says 0 "reproduce.sh: open $work/first/report.html in a browser" --quick
for method in raymoval_plus raymoval octomap peopleremover removert erasor dufomap; do
  holds "--quick: the table has $method" grep -q "^town,$method,.*,ok," first/results.csv
done
holds "--quick: the scene is short" grep -qE "run --sequence town:scans=[1-9][0-9] " asked.txt
holds "--quick: the page has the points" grep -q "keep-removals" asked.txt
holds "--quick: there is a page" test -s first/report.html
holds "--quick: the program is built and nothing else" grep -qx -- \
  "--build --preset release --target raymoval_program" built.txt
holds "--quick: it is built as anybody builds it" grep -qx -- "--preset release" built.txt
finish reproduce
