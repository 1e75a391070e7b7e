#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""An external method that removes at random: most points of some cubes of a metre, and a few
others, so that voxels are lost, thinned and kept."""
import random
import shutil
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from sequence_files import read_points

KEPT, REMOVED = 9, 251


def main():
    for path in sorted(Path("velodyne").glob("*.bin")):
        generator = random.Random(path.stem)
        cubes = {}
        words = []
        for point in read_points(path):
            cube = tuple(int(value // 1.0) for value in point)
            share = cubes.setdefault(cube, generator.choice([0.03, 0.03, 0.9]))
            words.append(REMOVED if generator.random() < share else KEPT)
        answer = struct.pack(f"<{len(words)}I", *words)
        Path("predictions", f"{path.stem}.label").write_bytes(answer)
    if sys.argv[1] != "none":
        shutil.copytree("velodyne", Path(sys.argv[1]) / "velodyne")
        for name in ("poses.txt", "calib.txt"):
            shutil.copy(name, sys.argv[1])


if __name__ == "__main__":
    main()
