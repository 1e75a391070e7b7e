#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Removes what stands in voxels that other scans look through.

Runs in a working folder that raymoval fills (see docs/your-method.md):
velodyne/NNNNNN.bin, poses.txt, parameters.json; answers with predictions/NNNNNN.label.
"""
import json
from pathlib import Path

import numpy as np

KEPT, REMOVED = 9, 251


def read_poses(path):
    """T_world_sensor of every scan: (n, 3, 4), metres."""
    return np.loadtxt(path, ndmin=2).reshape(-1, 3, 4)


def read_points(scan):
    """Points of scan number `scan` in the sensor frame: (n, 3), metres."""
    values = np.fromfile(f"velodyne/{scan:06d}.bin", np.float32).reshape(-1, 4)
    return values[:, :3].astype(np.float64)


def pixels_of(points, pixel):
    """Pixel of each point in an image of directions, and its range in metres."""
    across = np.hypot(points[:, 0], points[:, 1])
    azimuth = np.degrees(np.arctan2(points[:, 1], points[:, 0])) % 360.0
    elevation = np.degrees(np.arctan2(points[:, 2], across)) + 90.0
    columns, rows = int(np.ceil(360.0 / pixel)), int(np.ceil(180.0 / pixel)) + 1
    column = np.minimum((azimuth / pixel).astype(np.int64), columns - 1)
    row = (elevation / pixel).astype(np.int64)
    return row * columns + column, np.hypot(across, points[:, 2]), rows * columns


def occupied_voxels(poses, size):
    """Centres of all voxels with a point in them: (m, 3); and of each scan the voxel of each
    point and a list of those it has points in."""
    keys = []
    for scan, pose in enumerate(poses):
        world = read_points(scan) @ pose[:, :3].T + pose[:, 3]
        keys.append(np.floor(world / size).astype(np.int64))
    voxels, owner = np.unique(np.concatenate(keys), axis=0, return_inverse=True)
    owners = np.split(owner.ravel(), np.cumsum([len(k) for k in keys])[:-1])
    return (voxels + 0.5) * size, owners


def count_scans(poses, centres, owners, parameters):
    """How many scans have a point in each voxel, and how many look through it."""
    hits = np.zeros(len(centres), np.int64)
    through = np.zeros(len(centres), np.int64)
    for scan, pose in enumerate(poses):
        seen = np.unique(owners[scan])
        hits[seen] += 1
        pixel, distance, count = pixels_of(read_points(scan), parameters["pixel"])
        nearest = np.full(count, np.inf)
        np.minimum.at(nearest, pixel, distance)
        nearest[np.isinf(nearest)] = 0.0  # No return says nothing.
        where, far, _ = pixels_of((centres - pose[:, 3]) @ pose[:, :3], parameters["pixel"])
        behind = far + parameters["margin"] + parameters["range_margin"] * far
        looked = nearest[where] > behind
        looked[seen] = False
        through += looked
    return hits, through


def main():
    parameters = json.loads(Path("parameters.json").read_text())
    poses = read_poses("poses.txt")
    centres, owners = occupied_voxels(poses, parameters["voxel_size"])
    hits, through = count_scans(poses, centres, owners, parameters)
    removed = (through >= parameters["minimum_through"]) & (
        through > parameters["through_share"] * (hits + through))
    for scan, owner in enumerate(owners):
        words = np.where(removed[owner], REMOVED, KEPT).astype("<u4")
        words.tofile(f"predictions/{scan:06d}.label")


if __name__ == "__main__":
    main()
