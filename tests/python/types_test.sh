#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The package's types: mypy finds nothing in it, nor in a caller that uses it rightly, and something
# in one that does not; stubtest holds the stub against the compiled module.
# Usage: types_test.sh PYTHON PACKAGE_FOLDER        77: there is no mypy
set -uo pipefail
python=$1
package=$(readlink -f "$2")
export PYTHONPATH=$package MYPYPATH=$package
source "$(dirname "${BASH_SOURCE[0]}")/../cli/checks.sh"
if ! "$python" -c 'import mypy' 2>/dev/null; then
  echo "types_test.sh: mypy (Debian's package mypy) is missing; the stub is not checked."
  exit 77
fi
mypy=("$python" -m mypy --strict --no-warn-unused-ignores
  --cache-dir "$work/cache")
holds "mypy finds nothing in the package" "${mypy[@]}" -p raymoval
cat >right.py <<'END'
import numpy as np
import raymoval

class Near(raymoval.Remover):
    distance = 3.0
    def run(self, scans: raymoval.Scans, sink: raymoval.Sink) -> None:
        for scan in scans:
            sink.accept(scan.index, np.linalg.norm(scan.points, axis=1) < self.distance)

masks = raymoval.clean([np.zeros((3, 3), np.float32)], np.zeros((1, 4, 4)), Near(), threads=2)
count: int = masks.removed_count
street = raymoval.open("street", frames="0:5")
score = raymoval.score(street, masks)["erasor"]["F1"]
assert score is None or score > 0.5
END
holds "mypy finds nothing in a right caller" "${mypy[@]}" right.py
cat >wrong.py <<'END'
import raymoval
raymoval.estimate(5)
raymoval.open(5)
raymoval.open("street")[0].point
raymoval.describe("raymoval").parameters
END
"${mypy[@]}" wrong.py >wrong.txt 2>&1
holds "mypy finds four mistakes in a wrong caller: $(cat wrong.txt)" \
  test "$(grep -c 'wrong.py:.*error' wrong.txt)" -ge 4
# pybind11's classes have a metaclass and an __init__ of its own; their members are compared.
printf '%s\n' 'raymoval\._raymoval\.[A-Za-z]+(\.__init__)?' >known.txt
holds "the stub is that of the module" "$python" -m mypy.stubtest raymoval._raymoval --allowlist known.txt
sed 's/def accept/def take/' "$package/raymoval/_raymoval.pyi" >changed.pyi
cp -rL "$package/raymoval" . && cp changed.pyi raymoval/_raymoval.pyi
export PYTHONPATH=$work MYPYPATH=$work
"$python" -m mypy.stubtest raymoval._raymoval --allowlist known.txt >changed.txt 2>&1
holds "a wrong stub is found: $(head -3 changed.txt)" grep -q 'Sink.take' changed.txt
finish types
