#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads pose files in the forms in which programs write them: a line for each.

    poses.py PROGRAM    PROGRAM is raymoval_formats; scripts/formats.sh builds it

Each stands beside four scans; the pose of each scan has to be the expected one within 1e-9. Where
a program rounds, what it rounded to is expected. NumPy writes its own arrays and tables; the other
texts are written by Python after the sources of the programs that they are named after.
"""
import datetime
import math
import os
import struct
import sys
import tempfile

import numpy as np

from motion import (MOUNT, PERIOD_NS, SCANS, START_NS, STAMPS, body, from_euler, from_quaternion,
                    from_vector, near, quaternion)
from table import Table, asked

TABLE = Table()
POSES = [body(stamp) for stamp in STAMPS]
# As poses come that are taken between scans, from before the first to behind the last.
BETWEEN = [START_NS + (2 * i - 1) * PERIOD_NS // 2 for i in range(SCANS + 1)]


def numbers(values, form="{!r}", separator=" "):
    return separator.join(form.format(float(value)) for value in values)


def seconds(stamp):
    return f"{stamp // 10**9}.{stamp % 10**9:09d}"


def tum_row(pose, form="{!r}", separator=" "):
    return numbers([*pose[:3, 3], *quaternion(pose)], form, separator)


def try_poses(name, variant, content, expected, by="Python", times=STAMPS, names=None, **options):
    """One sequence of plain scans with this pose file. `times`: those of times.txt, or none."""
    with tempfile.TemporaryDirectory() as folder:
        for i in range(SCANS):
            scan = (names or [f"{i:06d}" for i in range(SCANS)])[i]
            with open(f"{folder}/{scan}.bin", "wb") as file:
                file.write(struct.pack("<8f", 1, 2, 3, 0, 4, 5, 6, i))
        if times is not None:
            with open(f"{folder}/times.txt", "w", encoding="ascii") as file:
                file.write("".join(f"{seconds(t) if isinstance(t, int) else t}\n" for t in times))
        for file_name, bytes_of in {name: content, **options.pop("files", {})}.items():
            if callable(bytes_of):
                bytes_of(f"{folder}/{file_name}")
                continue
            with open(f"{folder}/{file_name}", "wb") as file:
                file.write(bytes_of.encode() if isinstance(bytes_of, str) else bytes_of)
        words = [f"{key.replace('_', '-')}={value}" for key, value in options.items()]
        answer = asked("sequence", folder, f"poses={name}", *words)
        kind, _, rest = variant.partition(": ")
        TABLE.say(kind, rest, by, "read", near(answer, expected))


def rows(rows_of, stamps=STAMPS):
    return "".join(rows_of(stamp) + "\n" for stamp in stamps)


def try_matrices():
    def twelve(stamp):
        return numbers(body(stamp)[:3].ravel())

    try_poses("poses.txt", "kitti: 12 numbers", rows(twelve), POSES)
    rounded = [np.vstack([np.array([float(f"{v:.6e}") for v in pose[:3].ravel()]).reshape(3, 4),
                          [0, 0, 0, 1]]) for pose in POSES]
    for pose in rounded:  # What is rounded is made a rotation again.
        u, _, v = np.linalg.svd(pose[:3, :3])
        pose[:3, :3] = u @ v
    text = "".join(numbers(pose[:3].ravel(), "{:.6e}") + "\n" for pose in POSES)
    try_poses("poses.txt", "kitti: 7 digits, as KITTI has them", text, rounded)
    try_poses("poses.txt", "kitti: as KISS-ICP's _kitti.txt", lambda path: np.savetxt(
        path, [pose[:3].ravel() for pose in POSES]), POSES, "NumPy")
    try_poses("poses.txt", "kitti: comments and empty lines",
              "# poses\n\n" + rows(twelve).replace("\n", "\r\n"), POSES)
    try_poses("global_pose.csv", "kitti: nanoseconds and 12 numbers (MulRan)",
              rows(lambda t: f"{t}," + numbers(body(t)[:3].ravel(), separator=",")), POSES)
    try_poses("poses.txt", "kitti: seconds and 12 numbers, between the scans",
              rows(lambda t: seconds(t) + " " + twelve(t), BETWEEN), POSES)
    sixteen = lambda t: numbers(body(t).ravel())
    try_poses("poses.txt", "matrix: 16 numbers", rows(sixteen), POSES)
    try_poses("poses.txt", "matrix: a time and 16 numbers",
              rows(lambda t: seconds(t) + " " + sixteen(t), BETWEEN), POSES)
    try_poses("poses.txt", "matrix: blocks of four lines", "\n".join(
        "".join(numbers(row) + "\n" for row in pose) for pose in POSES), POSES)
    for variant, array in {"N x 4 x 4": np.array(POSES), "N x 3 x 4": np.array(POSES)[:, :3],
                           "N x 12": np.array(POSES)[:, :3].reshape(SCANS, 12),
                           "N x 16": np.array(POSES).reshape(SCANS, 16),
                           "big-endian": np.array(POSES).astype(">f8"),
                           "N x 4 x 4, Fortran order": np.asfortranarray(np.array(POSES)),
                           "N x 12, Fortran order": np.asfortranarray(
                               np.array(POSES)[:, :3].reshape(SCANS, 12))}.items():
        try_poses("poses.npy", "npy: " + variant, lambda path, a=array: np.save(path, a), POSES,
                  "NumPy")


def try_quaternions():
    row = lambda t: seconds(t) + " " + tum_row(body(t))
    try_poses("traj.txt", "tum: seconds", rows(row), POSES)
    try_poses("traj.txt", "tum: with a line of names", "# timestamp tx ty tz qx qy qz qw\n" +
              rows(row), POSES)
    try_poses("traj.txt", "tum: between the scans", rows(row, BETWEEN), POSES)
    try_poses("traj.txt", "tum: nanoseconds and a point, as ORB-SLAM3",
              rows(lambda t: f"{t}.0 " + tum_row(body(t))), POSES)
    try_poses("traj.csv", "tum: between commas",
              rows(lambda t: seconds(t) + "," + tum_row(body(t), separator=",")), POSES)
    nine = [from_quaternion(*np.split(np.array([float(f"{v:.9f}") for v in
                                                [*p[:3, 3], *quaternion(p)]]), [3])) for p in POSES]
    try_poses("traj_lidar.txt", "tum: 9 decimals, as GLIM's traj_lidar.txt",
              rows(lambda t: seconds(t) + " " + tum_row(body(t), "{:.9f}")), nine)
    table = np.array([[t * 1e-9, *body(t)[:3, 3], *quaternion(body(t))] for t in STAMPS])
    try_poses("traj.txt", "tum: as np.savetxt writes it (KISS-ICP, evo)",
              lambda path: np.savetxt(path, table), POSES, "NumPy", times=None)
    wxyz = lambda pose: [*pose[:3, 3], quaternion(pose)[3], *quaternion(pose)[:3]]
    head = ("#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
            "q_RS_z []")
    eight = lambda t: f"{t}," + numbers(wxyz(body(t)), separator=",")
    rest = ",".join(["0.0"] * 9)
    try_poses("data.csv", "csv: EuRoC's 8 columns with names", head + "\n" + rows(eight), POSES)
    try_poses("data.csv", "euroc: 17 columns", rows(lambda t: eight(t) + "," + rest), POSES)
    names = head + "".join(f", {n} []" for n in "v_x v_y v_z b_w_x b_w_y b_w_z b_a_x b_a_y b_a_z".split())
    try_poses("data.csv", "csv: EuRoC's 17 columns with names", names + "\n" + rows(
        lambda t: eight(t) + "," + rest), POSES)
    try_poses("data.csv", "euroc: 8 columns, said", rows(eight), POSES, pose_format="euroc")
    try_poses("pose.json", "hba: 7 numbers in pose.json", rows(lambda t: numbers(wxyz(body(t)))),
              POSES)
    g2o = "".join(f"VERTEX_SE3:QUAT {7 * (SCANS - i)} {tum_row(POSES[SCANS - 1 - i])}\n"
                  for i in reversed(range(SCANS)))
    edge = "EDGE_SE3:QUAT 7 14 1 0 0 0 0 0 1" + " 1" * 21 + "\n"
    try_poses("graph.g2o", "g2o: ids out of order, and edges", g2o + edge,
              POSES)


def try_columns():
    def line(t, *more):
        return [*more, *map(repr, map(float, body(t)[:3, 3])), *map(repr, map(float, quaternion(body(t))))]

    names = "x,y,z,qx,qy,qz,qw"
    try_poses("p.csv", "csv: time and names", f"time,{names}\n" + rows(
        lambda t: ",".join(line(t, seconds(t))), BETWEEN), POSES)
    try_poses("p.csv", "csv: sec and nsec", f"sec,nsec,{names}\n" + rows(
        lambda t: ",".join(line(t, str(t // 10**9), str(t % 10**9)))), POSES)
    try_poses("p.csv", "csv: semicolons, another order", "qw;qz;qy;qx;z;y;x;stamp\n" + rows(
        lambda t: ";".join(reversed(line(t, seconds(t))))), POSES)
    try_poses("p.csv", "csv: microseconds named", f"time_us,{names}\n" + rows(
        lambda t: ",".join(line(t, str(t // 1000))), [t - 123 for t in STAMPS] + [STAMPS[-1] + 877]),
        POSES)
    angles = lambda t: [0.02, -0.1, 0.3 + 2 * (t - START_NS) * 1e-9]
    euler = [from_euler(body(t)[:3, 3], *angles(t)) for t in STAMPS]
    for unit, factor in {"": 1, " [deg]": 180 / math.pi}.items():
        head = "time,x,y,z," + ",".join(a + unit for a in ("roll", "pitch", "yaw"))
        try_poses("p.csv", "csv: roll pitch yaw" + unit, head + "\n" + rows(
            lambda t, f=factor: f"{seconds(t)}," + numbers(
                [*body(t)[:3, 3], *[a * f for a in angles(t)]], separator=",")), euler)
    vector = lambda t: np.array([0.1, -0.2, 0.4]) * (1 + (t - START_NS) * 1e-9)
    log = lambda t: f"{(t - STAMPS[0]) * 1e-9!r} " + numbers([*vector(t), *body(t)[:3, 3], *[0] * 18])
    try_poses("pos_log.txt", "fast-lio: pos_log.txt", rows(log),
              [from_vector(body(t)[:3, 3], vector(t)) for t in STAMPS], times=None)
    for data in ("ascii", "binary"):
        try_poses("transformations.pcd", f"lio-sam: {data}", lio_sam(data, angles), [from_euler(
            *np.split(np.float32([*body(t)[:3, 3], *angles(t)]).astype(float), [3])[:1],
            *np.float32(angles(t)).astype(float)) for t in STAMPS], times=None)
    end = numbers([9, 9, 9])
    half = lambda t, blank: f"0 {seconds(t)} 0 -1{blank}" + numbers([*quaternion(body(t)),
                                                                   *body(t)[:3, 3]])
    for variant, blank in {"22 numbers": " ", "20 numbers, as it writes them": ""}.items():
        try_poses("trajectory.txt", "ct-icp: " + variant, rows(
            lambda t, b=blank: half(t, b) + f" 0 {seconds(t + PERIOD_NS)} 0 -1{b}0.0 0.0 0.0 1.0 {end}"),
            POSES, times=None)


def lio_sam(data, angles):
    head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity roll pitch yaw time\n"
            "SIZE 4 4 4 4 4 4 4 8\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\n"
            f"WIDTH {SCANS}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {SCANS}\nDATA {data}\n")
    values = [(*np.float32([*body(t)[:3, 3], i, *angles(t)]), t * 1e-9)
              for i, t in enumerate(STAMPS)]
    if data == "binary":
        return head.encode() + b"".join(struct.pack("<7fd", *row) for row in values)
    return head + "".join(numbers(row) + "\n" for row in values)


def try_options():
    row = lambda t: seconds(t) + " " + tum_row(body(t))
    mounted = [pose @ MOUNT for pose in POSES]
    seven = [*MOUNT[:3, 3], *quaternion(MOUNT)]
    said = numbers(seven, separator=",")
    try_poses("t.txt", "--T-sensor: numbers, poses between the scans", rows(row, BETWEEN), mounted, T_sensor=said)
    try_poses("t.txt", "--T-sensor: a file of numbers", rows(row), mounted, T_sensor="mount.txt",
              files={"mount.txt": numbers(seven) + "\n"})
    try_poses("t.txt", "--T-sensor: a file with a 4 x 4 matrix", rows(row), mounted, T_sensor="mount.txt",
              files={"mount.txt": "".join(numbers(r) + "\n" for r in MOUNT)})
    late = 30_000_000
    try_poses("t.txt", "--time-offset: 0.03", rows(row, BETWEEN), [body(t + late) for t in STAMPS],
              time_offset=0.03)
    try_poses("t.txt", "--time-offset: with --T-sensor", rows(row, BETWEEN),
              [body(t + late) @ MOUNT for t in STAMPS], time_offset=0.03, T_sensor=said)
    inverse = lambda t: seconds(t) + " " + tum_row(np.linalg.inv(body(t)))
    try_poses("t.txt", "--pose-format: inverse", rows(inverse), POSES, pose_format="inverse")
    try_poses("t.txt", "--pose-format: tum:inverse", rows(inverse), POSES, pose_format="tum:inverse")
    apart = [STAMPS[0], STAMPS[-1]]
    try_poses("t.txt", "--max-gap: 0.4, with two poses", rows(row, apart), POSES, max_gap=0.4)
    try_poses("t.txt", "by time: a scan without a pose is left out", rows(row, STAMPS[:-1]), POSES[:-1])
    try_poses("t.txt", "standing sensor: one pose", rows(row, STAMPS[:1]), [POSES[0]] * SCANS)
    for variant, unit in {"milliseconds": 10**6, "microseconds": 10**3, "nanoseconds": 1}.items():
        whole = [t // unit * unit for t in STAMPS]
        try_poses("t.txt", "times.txt: " + variant, rows(row, BETWEEN), [body(t) for t in whole],
                  times=[str(t // unit) for t in whole])
    day = lambda t: datetime.datetime.fromtimestamp(t // 10**9, datetime.timezone.utc).strftime(
        "%Y-%m-%d %H:%M:%S") + f".{t % 10**9:09d}"
    try_poses("t.txt", "timestamps.txt: dates, as in KITTI's raw data", rows(row, BETWEEN), POSES,
              times=None, files={"timestamps.txt": "".join(day(t) + "\n" for t in STAMPS)})
    for variant, form in {"seconds": seconds, "nanoseconds": str,
                          "sec_nsec": lambda t: seconds(t).replace(".", "_")}.items():
        try_poses("t.txt", "names of scans: " + variant, rows(row, BETWEEN), POSES,
                  times=None, names=[form(t) for t in STAMPS])
    try_poses("t.txt", "tum: quaternions with the other sign", rows(lambda t: seconds(t) + " " + numbers(
        [*body(t)[:3, 3], *(-quaternion(body(t)))])), POSES)
    try_poses("identity", "standing sensor: --poses identity", "", [np.eye(4)] * SCANS)


def main():
    for part in (try_matrices, try_quaternions, try_columns, try_options):
        part()
    return TABLE.finish()


if __name__ == "__main__":
    os.environ["LC_ALL"] = "C"
    sys.exit(main())
