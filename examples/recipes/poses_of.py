#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the poses of the LiDAR as rows of 12 numbers (KITTI's form), one for each scan.

Usage: poses_of.py kitti-raw DRIVE CALIBRATION     writes DRIVE/poses.txt
       poses_of.py hdl-graph-slam DUMP FOLDER      writes FOLDER/poses.txt, and links to the clouds

DRIVE is a synchronised drive of KITTI raw (`..._sync`), and CALIBRATION its calib_imu_to_velo.txt.
DUMP is what hdl_graph_slam saves: a folder for each key frame, with `cloud.pcd` and `data`.
"""
import math
import pathlib
import sys

EARTH_RADIUS = 6378137.0  # metres, as in KITTI's development kit


def product(a, b):
    """Of two rigid motions, each 3 rows of 4 numbers."""
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0.0) for j in range(4)]
            for i in range(3)]


def inverse(a):
    rotation = [[a[j][i] for j in range(3)] for i in range(3)]
    return [row + [-sum(row[k] * a[k][3] for k in range(3))] for row in rotation]


def rotation(roll, pitch, yaw):
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(angle), math.cos(angle)) for angle in (roll, pitch, yaw))
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr]]


def imu_pose(numbers, scale):
    """From a row of oxts: latitude, longitude (degrees), altitude (m), roll, pitch, yaw (radians)."""
    latitude, longitude, altitude = numbers[:3]
    place = [scale * EARTH_RADIUS * math.radians(longitude),
             scale * EARTH_RADIUS * math.log(math.tan(math.radians(90.0 + latitude) / 2.0)), altitude]
    return [row + [at] for row, at in zip(rotation(*numbers[3:6]), place)]


def kitti_raw(drive, calibration):
    rows = dict(line.split(":", 1) for line in calibration.read_text().splitlines() if ":" in line)
    turn, place = ([float(n) for n in rows[key].split()] for key in ("R", "T"))
    velo_imu = [turn[3 * i:3 * i + 3] + [place[i]] for i in range(3)]
    scans = sorted((drive / "velodyne_points/data").glob("*.bin"))  # some drives lack scans
    oxts = [[float(n) for n in (drive / f"oxts/data/{scan.stem}.txt").read_text().split()] for scan in scans]
    scale = math.cos(math.radians(oxts[0][0]))
    poses = [product(imu_pose(numbers, scale), inverse(velo_imu)) for numbers in oxts]
    first = [pose[3] for pose in poses[0]]
    for pose in poses:  # Near the origin, so that no digit is lost.
        for row, start in zip(pose, first):
            row[3] -= start
    write(drive, poses)


def hdl_graph_slam(dump, folder):
    folder.mkdir(exist_ok=True)
    poses = []
    for keyframe in sorted(path for path in dump.iterdir() if (path / "cloud.pcd").is_file()):
        words = (keyframe / "data").read_text().split()
        numbers = [float(n) for n in words[words.index("estimate") + 1:][:12]]
        poses.append([numbers[4 * i:4 * i + 4] for i in range(3)])
        link = folder / f"{keyframe.name}.pcd"
        link.unlink(missing_ok=True)
        link.symlink_to((keyframe / "cloud.pcd").resolve())
    write(folder, poses)


def write(folder, poses):
    text = "".join(" ".join(repr(value) for row in pose for value in row) + "\n" for pose in poses)
    (folder / "poses.txt").write_text(text)
    print(f"{folder / 'poses.txt'}: {len(poses)} poses")


FORMS = {"kitti-raw": kitti_raw, "hdl-graph-slam": hdl_graph_slam}
if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in FORMS:
        sys.exit(__doc__)
    FORMS[sys.argv[1]](pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
