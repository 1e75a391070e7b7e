#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Cleans a map and shows it: from arrays, as a notebook has them.

    clean_map.py [SEQUENCE] [OUTPUT.npy]      default: the scene `street`, no output
"""
import sys

import numpy as np

import raymoval

place = sys.argv[1] if len(sys.argv) > 1 else "street"
sequence = raymoval.open(place)
print(sequence, "with", sequence.sensor)

# Any list or generator of arrays will do; these are here to show what `clean` takes.
scans = [scan.points for scan in sequence]
poses = sequence.poses
masks = raymoval.clean(scans, poses, sensor=sequence.sensor, up=sequence.up)
print(masks)


def in_world(points, pose):
    return points @ pose[:3, :3].T + pose[:3, 3]


static = np.concatenate([in_world(scan[~mask], pose)
                         for scan, mask, pose in zip(scans, masks, poses)])
moving = np.concatenate([in_world(scan[mask], pose)
                         for scan, mask, pose in zip(scans, masks, poses)])
print(f"the map keeps {len(static):,} points and loses {len(moving):,}")
if sequence.has_labels:
    print(raymoval.score(sequence, masks, ["erasor", "dynamicmap"]))
if len(sys.argv) > 2:
    np.save(sys.argv[2], static.astype(np.float32))

try:
    import matplotlib

    matplotlib.use("Agg")  # Leave this line out in a notebook.
    import matplotlib.pyplot as plt
except ImportError:
    print("matplotlib is not installed: no picture")
else:
    figure, axes = plt.subplots(figsize=(10, 5))
    axes.scatter(*static[::7, :2].T, s=0.1, c="0.6")
    axes.scatter(*moving[:, :2].T, s=0.5, c="tab:red")
    axes.set_aspect("equal")
    figure.savefig("cleaned.png", dpi=150)
    print("wrote cleaned.png")
