#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a method in twenty lines and compares it with ERASOR.

    write_method.py [SEQUENCE]      default: the scene `street`
"""
import sys

import numpy as np

import raymoval


class RarelySeen(raymoval.Remover):
    """Removes what stands in voxels in which few scans have points, though many could see them."""

    voxel_size = 0.4  # metres
    radius = 15.0  # metres: within it a scan sees what is there
    least_share = 0.3  # of the scans that could see a voxel

    def run(self, scans, sink):
        world = [scan.points @ scan.pose[:3, :3].T + scan.pose[:3, 3] for scan in scans]
        cells = [np.floor(points / self.voxel_size).astype(int) for points in world]
        voxels, owner = np.unique(np.concatenate(cells), axis=0, return_inverse=True)
        owners = np.split(owner.ravel(), np.cumsum([len(one) for one in cells])[:-1])
        hits, looks = np.zeros(len(voxels)), np.zeros(len(voxels))
        for pose, seen in zip(scans.poses, owners):
            hits[np.unique(seen)] += 1
            away = np.linalg.norm((voxels + 0.5) * self.voxel_size - pose[:3, 3], axis=1)
            looks += away < self.radius
        rare = hits < self.least_share * looks
        for scan, seen in enumerate(owners):
            sink.accept(scan, rare[seen])


place = sys.argv[1] if len(sys.argv) > 1 else "street"
run = raymoval.run(place, [RarelySeen, "erasor:version2"], protocols=["erasor", "dynamicmap"])
for failure in run.failures:
    print("failed:", failure)
for row in run.rows:
    if row["protocol"] == "erasor" and row["status"] == "ok":
        print(f"{row['cell']:22} PR {row['PR']:7.3f}  RR {row['RR']:7.3f}  F1 {row['F1']:.4f}")
sys.exit(0 if run.good else 1)
