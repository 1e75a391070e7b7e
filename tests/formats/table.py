# SPDX-License-Identifier: MIT
"""What the comparisons of this folder share: the table that they print, and what raymoval reads."""
import json
import subprocess
import sys

import numpy as np

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "raymoval_formats"
TYPES = {"F": "f", "I": "i", "U": "u"}


class Table:
    """A row for each format and variant: by which program, read or written, and whether equal."""

    def __init__(self):
        self.rows = []

    def say(self, file_format, variant, other, way, equal):
        """@param equal whether, or why it was not tried"""
        text = equal if isinstance(equal, str) else "equal" if equal else "DIFFERENT"
        self.rows.append((file_format, variant, other, way, text))

    def finish(self):
        """Prints the rows. @return the exit code: 1 if one differs"""
        titles = ("format", "variant", "by", "way", "result")
        widths = [max(len(row[i]) for row in self.rows + [titles]) for i in range(5)]
        for row in [titles] + self.rows:
            print("  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip())
        different = sum(row[4] == "DIFFERENT" for row in self.rows)
        untried = sum(row[4].startswith("no ") for row in self.rows)
        others = sum(not row[2].startswith(("Python", "raymoval")) for row in self.rows)
        print(f"{len(self.rows)} rows, {others} of them by another program than Python; "
              f"{different} different, {untried} not tried.")
        return 1 if different else 0


def asked(*words):
    """What raymoval answers as JSON, or None with its message on standard error."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return json.loads(done.stdout or "{}")
    print(" ".join(map(str, words)) + ": " + done.stderr, file=sys.stderr)
    return None


def structured(records):
    """The rows that raymoval read, as a structured array."""
    names, formats, offsets = [], [], []
    for field in records["fields"]:
        kind = f"<{TYPES[field['type']]}{field['size']}"
        names.append(field["name"])
        formats.append((kind, (field["count"],)) if field["count"] != 1 else kind)
        offsets.append(field["offset"])
    dtype = np.dtype({"names": names, "formats": formats, "offsets": offsets,
                      "itemsize": records["row_bytes"]})
    return np.frombuffer(bytes.fromhex(records["rows"]), dtype)


def same(ours, expected):
    """Whether each field of `expected` is in `ours` with the same bytes, and no other."""
    if ours is None or len(ours) != len(expected):
        return False
    if set(ours.dtype.names or ()) != set(expected.dtype.names):
        return False
    for name in expected.dtype.names:
        a, b = np.ascontiguousarray(ours[name]), np.ascontiguousarray(expected[name])
        b = b.astype(b.dtype.newbyteorder("<"))
        if a.dtype != b.dtype or a.reshape(-1).tobytes() != b.reshape(-1).tobytes():
            return False
    return True


def made(fields, count=50, seed=1):
    """Random values of all types."""
    random = np.random.default_rng(seed)
    array = np.zeros(count, np.dtype(fields))
    for name in array.dtype.names:
        column = array[name]
        if column.dtype.kind == "f":
            array[name] = random.normal(0, 30, column.shape)
        else:
            info = np.iinfo(column.dtype)
            array[name] = random.integers(info.min, info.max, column.shape, column.dtype,
                                          endpoint=True)
    return array
