#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A wheel is built without a network and without build isolation, installed into a fresh environment
# that sees Debian's packages only, and both examples are run there.
# Usage: wheel_test.sh PYTHON BUILD_FOLDER        77: there is no pip
set -uo pipefail
python=$1
build=$(readlink -f "$2")
source_folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$source_folder/tests/cli/checks.sh"
unset PYTHONPATH
if ! "$python" -c 'import pip, venv, ensurepip' 2>/dev/null; then
  echo "wheel_test.sh: pip or venv (Debian's python3-pip, python3-venv) is missing; no wheel is built."
  exit 77
fi
holds "a wheel is built" "$python" -m pip wheel "$source_folder" --no-build-isolation --no-deps \
  --no-index --disable-pip-version-check --config-settings="build=$build" --wheel-dir wheels
wheel=$(find wheels -name 'raymoval-*.whl')
holds "there is one wheel: $wheel" test -f "$wheel"
holds "an environment is made" "$python" -m venv --system-site-packages own
holds "the wheel is installed" own/bin/python -m pip install --no-index --no-deps \
  --disable-pip-version-check "$wheel"
holds "it is what is imported" grep -qF "$work/own/lib" \
  <(own/bin/python -c 'import raymoval; print(raymoval.__file__)')
holds "no file tells where it was built" test -z \
  "$(grep -rlF -e "$source_folder/" -e "$build" own/lib/python3*/site-packages/raymoval \
     --include='*.so' --include='*.py*')"
for example in "$source_folder"/examples/python/*.py; do
  holds "${example##*/} runs" own/bin/python "$example"
  cat out.txt
done
finish wheel
