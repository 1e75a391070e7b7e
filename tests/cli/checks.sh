# SPDX-License-Identifier: MIT
# For the tests of the program: source it with the program's path in $raymoval.
shipped_suites=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../../benchmark/suites")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
checks=0
failures=0

complain() {
  failures=$((failures + 1))
  echo "FAILED: $1"
  sed 's/^/  out: /' out.txt | head -5
  sed 's/^/  err: /' err.txt | head -5
}

# expect CODE TEXT ARGUMENTS...: the exit code, and TEXT somewhere in the output.
expect() {
  local code=$1 text=$2 got
  shift 2
  checks=$((checks + 1))
  "$raymoval" "$@" >out.txt 2>err.txt
  got=$?
  if [[ $got -ne $code ]]; then
    complain "raymoval $*: exit code $got, expected $code"
  elif [[ -n $text ]] && ! grep -qF -- "$text" out.txt err.txt; then
    complain "raymoval $*: does not say '$text'"
  elif [[ $code -ne 0 ]] && ! grep -q '^raymoval: ' err.txt; then
    complain "raymoval $*: no 'raymoval: message' on standard error"
  fi
}

# holds NAME COMMAND...: any other condition.
holds() {
  checks=$((checks + 1))
  "${@:2}" >out.txt 2>err.txt || complain "$1"
}

# left_over: the processes of methods in this test's folder whose program has ended. Other tests have their own.
left_over() {
  local process
  for process in $(pgrep -f "^raymoval run-method" -P 1); do
    [[ $(readlink "/proc/$process/cwd") != "$work"* ]] || echo "$process"
  done
}

# make_drive FOLDER FIRST LAST STRIDE: a small sequence with these frames, in SemanticKITTI's layout.
make_drive() {
  python3 - "$@" <<'PY'
import pathlib, struct, sys
folder, row = pathlib.Path(sys.argv[1]), "1 0 0 0 0 1 0 0 0 0 1 0\n"
first, last, stride = map(int, sys.argv[2:])
for kind in ("velodyne", "labels"):
    (folder / kind).mkdir(parents=True)
(folder / "poses.txt").write_text(row * (last + 1))
(folder / "calib.txt").write_text("Tr: " + row)
for frame in range(first, last + 1, stride):
    points = [(5 + i, 3, 0, 0) for i in range(20)] + [(5 + frame % 7, -3, 0, 0)]
    (folder / f"velodyne/{frame:06d}.bin").write_bytes(b"".join(struct.pack("<4f", *p) for p in points))
    (folder / f"labels/{frame:06d}.label").write_bytes(struct.pack("<21I", *[50] * 20, 252))
PY
}

# edits_of PAGE KEY=JSON...: prints the edits that a page of `clean --html` exports, without corrections but
# for these keys.
edits_of() {
  python3 - "$@" <<'PY'
import json, re, sys, zlib
text = re.search(r'id="scene-0-review">([^<]*)<', open(sys.argv[1]).read()).group(1)
digits = [ord("<" if letter == "!" else letter) - ord("#") for letter in text]
bits = count = 0  # 13 bits in two digits of 91, the lowest first.
for low, high in zip(digits[::2], digits[1::2] + [0] * (len(digits) % 2)):
    bits |= (low + 91 * high) << count
    count += 13
stream = bits.to_bytes(count // 8 + 1, "little")
edits = {**json.loads(zlib.decompressobj().decompress(stream)), "keep": [], "remove": []}
edits.update((key, json.loads(value)) for key, value in (pair.split("=", 1) for pair in sys.argv[2:]))
print(json.dumps(edits))
PY
}

# sparse_vlp16: a sensor with every second column of a VLP-16: half of the points.
sparse_vlp16() {
  sed 's/"azimuth_step_deg": 0.2/"azimuth_step_deg": 0.4/' \
    "$shipped_suites/../../datasets/simulation/sensors/vlp16.json"
}

# suite_anywhere NAME: prints the path of a copy of a shipped suite that a build without PCL takes, too.
suite_anywhere() {
  sed 's/"octomap:ground", *//' "$shipped_suites/$1.json" >"$work/$1.json"
  echo "$work/$1.json"
}

# wait_for FILE PROCESS: until the file is there, or the process that should write it is gone.
wait_for() {
  until [[ -e $1 ]] || ! kill -0 "$2" 2>/dev/null; do sleep 0.05; done
}

# same_but_times DIR DIR: the same files, except for values that differ from run to run.
same_but_times() {
  diff <(without_times "$1") <(without_times "$2")
}

# without_times DIR: names and contents of the files, without measured values.
without_times() {
  (cd "$1" && find . -type f | sort | while read -r file; do
    echo "== $file"
    case $file in
      *.json) awk '/"checksum"/ { next }
                   /"measured": \{/ { match($0, /^ */); indent = RLENGTH; skip = 1; next }
                   skip && /^ *\}/ { match($0, /^ */); if (RLENGTH == indent) { skip = 0; next } }
                   !skip' "$file" ;;
      *.csv) sed -E 's/,[^,]*,[^,]*(,[^,]*)$/\1/' "$file" ;;
      *.md | *.tex) sed -E '/Time of/,$d
        /Sweep of/,/Each row/ { s/ +/ /g; s/-+/-/g; s/ [0-9.]+ (\||\\\\)$/ TIME/ }' "$file" ;;
      *) cksum <"$file" ;;
    esac
  done)
}

finish() {
  echo "$1: $((checks - failures)) of $checks checks hold"
  [[ $failures -eq 0 ]]
}
