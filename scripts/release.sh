#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes a release of the commit that is checked out: the source archive, the Debian packages of the
# program, the library and the Python package, the wheel, and SHA256SUMS.
# All is built from the archive, without network.
#
#   scripts/release.sh [--out DIR] [--twice] [--source-only]
#     --out DIR       folder of the files; it must not exist or be empty (default: build/dist)
#     --twice         builds a second time, in another folder without compiler cache, and compares bytes
#     --source-only   makes only the source archive
#
# The tree must be clean. Times in all files are that of the commit. docs/release.md says more.
# Exit codes: 0 done, 1 the second build has other bytes, 2 cannot be done.
set -euo pipefail
caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "release.sh: $1" >&2
  exit 2
}
out=build/dist twice= source_only=
while [[ $# -gt 0 ]]; do
  case $1 in
    --out)
      [[ $# -ge 2 && -n $2 ]] || fail "--out needs a folder: scripts/release.sh --out DIR"
      out=$2
      [[ $out == /* ]] || out=$caller/$out
      shift
      ;;
    --twice) twice=yes ;;
    --source-only) source_only=yes ;;
    -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/release.sh; exit 0 ;;
    *) fail "'$1' is unknown; expected --out DIR, --twice or --source-only." ;;
  esac
  shift
done

changes=$(git status --porcelain) || fail "a release is made of a commit, so a git repository is needed."
[[ -z $changes ]] || fail "the tree is not clean, so it is no commit: commit the changes or put them aside (git stash)
$(head -n 5 <<<"$changes")"
mkdir -p "$out"
[[ -z $(ls -A "$out") ]] || fail "$out is not empty; a release goes into a folder of its own."
out=$(readlink -f "$out")
version=$(sed -nE 's/^project\(raymoval VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
commit=$(git rev-parse HEAD)
SOURCE_DATE_EPOCH=$(git show -s --format=%ct HEAD)
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022
name=raymoval-$version
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

make_archive() {
  local top=$work/archive/$name
  mkdir -p "$top"
  git archive --format=tar HEAD | tar -x -C "$top"
  echo "$commit" >"$top/COMMIT"
  tar -C "$work/archive" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner \
    --mode='u+rw,go+r-w,a+X' --format=gnu -cf - "$name" | xz -T1 -6 >"$1"
}

# Without network, where the system lets a user have that.
apart=(unshare --map-current-user --net)
"${apart[@]}" true 2>/dev/null || apart=(env)

# build_from ARCHIVE FOLDER DIST: unpacks, builds and packs in FOLDER.
build_from() {
  mkdir -p "$2" "$3"
  tar -xJf "$1" -C "$2"
  local source=$2/$name build=$2/$name/build/release
  # Files do not contain their build folder, even with -g or an assertion.
  "${apart[@]}" cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$source=." -DRAYMOVAL_BUILD_TESTS=OFF -DCMAKE_UNITY_BUILD=ON \
    -DRAYMOVAL_PYTHON=ON >"$2/log.txt" 2>&1 &&
    "${apart[@]}" cmake --build "$build" ${RAYMOVAL_BUILD_JOBS:+-j "$RAYMOVAL_BUILD_JOBS"} >>"$2/log.txt" 2>&1 ||
    { tail -n 30 "$2/log.txt" >&2; fail "the build in $2 failed, see above."; }
  (cd "$build" && "${apart[@]}" cpack -B "$2/packages") >>"$2/log.txt" 2>&1 ||
    { tail -n 30 "$2/log.txt" >&2; fail "cpack failed, see above."; }
  cp "$2"/packages/*.deb "$3/"
  (cd "$source/python/backend" && /usr/bin/python3 -B -c "import raymoval_backend as backend
backend.build_wheel('$3', {'build': '$build'})") >>"$2/log.txt" 2>&1 ||
    { tail -n 30 "$2/log.txt" >&2; fail "the wheel could not be built, see above."; }
}

make_archive "$out/$name.tar.xz"
echo "release.sh: $name.tar.xz, $(du -h "$out/$name.tar.xz" | cut -f1), of commit ${commit:0:12}"
if [[ -z $source_only ]]; then
  echo "release.sh: building from the archive (${apart[0]})"
  build_from "$out/$name.tar.xz" "$work/one" "$out"
fi
if [[ -n $twice ]]; then
  mkdir "$work/again"
  make_archive "$work/again/$name.tar.xz"
  if [[ -z $source_only ]]; then
    echo "release.sh: building once more, elsewhere, without compiler cache"
    find "$work/archive" -exec touch -d '2001-01-01' {} +
    CCACHE_DISABLE=1 build_from "$work/again/$name.tar.xz" "$work/a/longer/path/of/the/second/build" "$work/again"
  fi
  (cd "$work/again" && sha256sum -- *) >"$work/again.txt"
  (cd "$out" && sha256sum -c "$work/again.txt") || {
    echo "release.sh: the second build has other bytes, see above." >&2
    exit 1
  }
fi
(cd "$out" && sha256sum -- * >"$work/sums" && mv "$work/sums" SHA256SUMS && cat SHA256SUMS)
echo "release.sh: wrote $out"
