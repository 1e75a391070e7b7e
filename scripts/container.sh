#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the image of the Dockerfile and tries it: `simulate`, `clean` and `run` on a mounted folder, as
# a user who is not root.
#
#   scripts/container.sh [--engine podman|docker|buildah] [--name NAME] [--build-arg KEY=VALUE ...]
#
# The engine is the first of these that is there; the name is raymoval. The Dockerfile says what may be
# given for the build, such as DEBIAN=13-slim. buildah is used without namespaces (--isolation chroot),
# so that it works inside of another container, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "container.sh: $1" >&2
  exit 2
}

engine=
name=raymoval
arguments=()
while [[ $# -gt 0 ]]; do
  case $1 in
    -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    --engine | --name)
      [[ $# -ge 2 && -n $2 ]] || fail "$1 needs a value"
      [[ $1 == --engine ]] && engine=$2 || name=$2
      shift 2 ;;
    --build-arg)
      [[ $# -ge 2 && -n $2 ]] || fail "$1 needs a value"
      arguments+=("$1" "$2")
      shift 2 ;;
    *) fail "'$1' is unknown; expected --engine, --name or --build-arg" ;;
  esac
done
for candidate in podman docker buildah; do
  [[ -n $engine ]] || ! command -v "$candidate" >/dev/null || engine=$candidate
done
[[ -n $engine ]] || fail "there is neither podman, docker nor buildah. Install one of them."
command -v "$engine" >/dev/null || fail "there is no $engine"
case $engine in podman | docker | buildah) ;; *) fail "'$engine' is unknown; expected podman, docker or buildah" ;; esac

work=$(mktemp -d)
working=
trap '[[ -z $working ]] || buildah rm "$working" >/dev/null; rm -rf "$work"' EXIT

case $engine in
  buildah) buildah bud --isolation chroot "${arguments[@]}" -t "$name" . ;;
  *) "$engine" build "${arguments[@]}" -t "$name" . ;;
esac

# Whoever starts it; for root somebody else, since what root can do says little.
user=$(id -u):$(id -g)
as_user=(-u "$user")
[[ $engine != podman ]] || as_user=(--userns=keep-id)
if [[ $(id -u) == 0 ]]; then
  user=12345:12345
  as_user=(-u "$user")  # podman maps users (keep-id) for others than root only.
  chown "$user" "$work"
fi
in_image() {
  echo "== raymoval $*"
  case $engine in
    buildah)
      [[ -n $working ]] || working=$(buildah from "$name")
      buildah run --isolation chroot --user "$user" -v "$work:/data" "$working" -- raymoval "$@" ;;
    *) "$engine" run --rm "${as_user[@]}" -v "$work:/data" "$name" "$@" ;;
  esac
}
in_image --version
in_image simulate town -o my_scans --scans 12 --sensor vlp16 --quiet
in_image clean my_scans -o static.pcd --quiet
in_image run --sequence my_scans --method raymoval:online --method raymoval_plus --quiet --out out
for file in static.pcd out/results.csv out/table.md; do
  [[ -s $work/$file ]] || { echo "container.sh: $file was not written" >&2; exit 1; }
  owner=$(stat -c '%u:%g' "$work/$file")
  [[ $owner == "$user" ]] || { echo "container.sh: $file is owned by $owner, expected $user" >&2; exit 1; }
done
grep -q '^town,raymoval,online,erasor,ok,' "$work/out/results.csv" ||
  { echo "container.sh: out/results.csv has no score of raymoval:online" >&2; exit 1; }
echo "container.sh: $engine built $name, and it cleans and runs."
