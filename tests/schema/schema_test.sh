#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs schema_test.py with a Python that has jsonschema. Usage: schema_test.sh PATH/TO/raymoval
set -uo pipefail
for python in python3 /usr/bin/python3; do
  if "$python" -c 'import jsonschema' 2>/dev/null; then
    exec "$python" "$(dirname "${BASH_SOURCE[0]}")/schema_test.py" "$1"
  fi
done
echo "schema_test.sh: no Python with jsonschema; run scripts/install_dependencies.sh --tests" >&2
exit 1
