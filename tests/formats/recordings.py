#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads recordings that other programs wrote, and has other programs read ours: a line for each.

    recordings.py PROGRAM    PROGRAM is raymoval_formats; scripts/formats.sh builds it

The others are ROS's rosbag and message classes (Debian's python3-rosbag), npm's @mcap/core and
@foxglove/rosmsg2-serialization (in the folder NODE_PATH), and Python's sqlite3, where they are
there. All fields of all points are compared bit for bit, and poses within 1e-9. What we write has
lost each second point, and everything else in it has to be what it was.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import containers
from messages import (Cloud, cdr_messages, genpy_message, livox, pose_value)
from motion import MOUNT, PERIOD_NS, SCANS, START_NS, STAMPS, body, near, turn
from table import Table, asked, made, same, structured

TABLE = Table()
XYZ = [("x", "<f4"), ("y", "<f4"), ("z", "<f4")]
USUAL = XYZ + [("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")]
POSES = [body(stamp) for stamp in STAMPS]
ODOMETRY = "nav_msgs/Odometry"
CLOUD = "sensor_msgs/PointCloud2"
# Poses are taken between the scans, from before the first to behind the last.
BETWEEN = [START_NS + (2 * i - 1) * PERIOD_NS // 2 for i in range(SCANS + 1)]


def has(module):
    try:
        __import__(module)
        return True
    except ImportError:
        return False


def has_npm():
    return cdr_messages([("geometry_msgs/PoseStamped", pose_value(
        "geometry_msgs/PoseStamped", [(START_NS, POSES[0])], "odom", ""))]) is not None


ROSBAG = has("rosbag") and has("sensor_msgs") and has("nav_msgs") and has("tf2_msgs")


def in_order(messages):
    return sorted(messages, key=lambda message: message[2])


def of_value(form, kind, value):
    """The bytes of one message, by the program that knows this form."""
    if form != "ROS 1":
        return cdr_messages([(kind, value)])[0]
    import io  # pylint: disable=import-outside-toplevel
    buffer = io.BytesIO()
    genpy_message(kind, value).serialize(buffer)
    return buffer.getvalue()


def clouds():
    return [Cloud(made(USUAL, 40, seed)) for seed in range(SCANS)]


class Drive:
    """Scans along the motion, and odometry of the sensor."""

    def __init__(self, form, scans=None, stamps_of_odometry=BETWEEN):
        self.form = form
        self.clouds = scans or clouds()
        values = [(ODOMETRY, pose_value(ODOMETRY, [(t, body(t))], "odom", "lidar"))
                  for t in stamps_of_odometry]
        made_by = cdr_messages(values) if form == "CDR" else [of_value(form, *v) for v in values]
        poses = [("/odom", ODOMETRY, t, data) for t, data in zip(stamps_of_odometry, made_by)]
        self.messages = in_order(poses + [
            ("/points", CLOUD, t, cloud.bytes(form, t)) for t, cloud in zip(STAMPS, self.clouds)])


def holds(answer, arrays, poses):
    return near(answer, poses) and all(
        same(structured(scan), array) for scan, array in zip(answer["scans"], arrays))


def read_row(kind, variant, by, path, drive, *words):
    arrays = [cloud.array for cloud in drive.clouds]
    TABLE.say(kind, variant, by, "read", holds(asked("sequence", path, *words), arrays, POSES))


def cut_row(kind, variant, by, path, drive):
    """It holds the first scans, of which some are missing, and says so."""
    answer = asked("sequence", path)
    count = len(answer["scans"]) if answer else 0
    arrays = [cloud.array for cloud in drive.clouds][:count]
    equal = 0 < count < SCANS and len(answer["notes"]) > 1
    TABLE.say(kind, f"{variant}: {count} of {SCANS} scans, said", by, "read",
              equal and holds(answer, arrays, POSES[:count]))


# --- containers ---
def try_ros1(folder):
    if not ROSBAG:
        return TABLE.say("ROS 1", "all", "rosbag", "read", "no python3-rosbag")
    drive = Drive("ROS 1")
    path = f"{folder}/a.bag"
    for packing in ("none", "bz2", "lz4"):
        for variant, size in {"one chunk": 1 << 20, "a chunk a message": 1}.items():
            containers.write_ros1(path, drive.messages, compression=packing, chunk_threshold=size)
            read_row("ROS 1", f"{packing}, {variant}", "rosbag", path, drive)
    later = drive.messages[-1:] + drive.messages[:-1]
    containers.write_ros1(path, later)
    read_row("ROS 1", "messages out of order", "rosbag", path, drive)
    with_other = [("/imu", "sensor_msgs/Imu", START_NS + i, b"\1" * 300) for i in range(50)]
    containers.write_ros1(path, with_other + drive.messages, compression="lz4")
    read_row("ROS 1", "with a topic of another type", "rosbag", path, drive)
    containers.write_ros1(path, drive.messages, chunk_threshold=1)
    whole = pathlib.Path(path).read_bytes()
    last = drive.messages[-2][3]
    pathlib.Path(path).write_bytes(whole[:whole.rindex(last) + 100])
    cut_row("ROS 1", "cut within the last cloud", "rosbag", path, drive)
    containers.write_ros1(path, drive.messages, closed=False, chunk_threshold=2000)
    answer = asked("sequence", path)
    arrays = [cloud.array for cloud in drive.clouds]
    TABLE.say("ROS 1", "never closed, without an index", "rosbag", "read",
              holds(answer, arrays, POSES) and len(answer["notes"]) > 1)


def try_mcap(folder):
    drive = Drive("CDR")
    path = lambda name: f"{folder}/{name}.mcap"
    bare = {"useStatistics": False, "useSummaryOffsets": False, "useChunkIndex": False,
            "repeatSchemas": False, "repeatChannels": False, "useMessageIndex": False}
    variants = {"chunks, not packed": {}, "lz4": {"packing": "lz4"}, "zstd": {"packing": "zstd"},
                "no chunks": {"useChunks": False}, "no statistics": {"useStatistics": False},
                "no chunk index": {"useChunkIndex": False},
                "no message index": {"useMessageIndex": False},
                "no schemas, channels in the summary":
                    {"repeatSchemas": False, "repeatChannels": False},
                "no summary, no index": bare, "no summary, no index, zstd": {"packing": "zstd", **bare},
                "one chunk": {"chunkSize": 1 << 20}}
    names = {variant: path(f"m{i}") for i, variant in enumerate(variants)}
    if not containers.write_mcap(*[containers.mcap_file(names[variant], drive.messages, **options)
                                   for variant, options in variants.items()]):
        return TABLE.say("MCAP", "all", "@mcap/core", "read", "no @mcap/core")
    for variant, name in names.items():
        read_row("MCAP", variant, "@mcap/core", name, drive)
    for variant in ("chunks, not packed", "zstd", "no chunks"):
        whole = pathlib.Path(names[variant]).read_bytes()
        cut = path("cut")
        pathlib.Path(cut).write_bytes(whole[:int(0.55 * len(whole))])
        cut_row("MCAP", f"{variant}, cut off", "@mcap/core", cut, drive)
    if ROSBAG:
        ros1 = Drive("ROS 1")
        containers.write_mcap(containers.mcap_file(path("ros1"), ros1.messages, profile="ros1"))
        read_row("MCAP", "of ROS 1", "@mcap/core", path("ros1"), ros1)


def try_db3(folder):
    drive = Drive("CDR")
    path = f"{folder}/a.db3"
    containers.write_db3(path, drive.messages)
    read_row("db3", "the file alone", "sqlite3", path, drive)
    packed = path + ".zstd"
    pathlib.Path(packed).write_bytes(containers.zstd(pathlib.Path(path).read_bytes()))
    read_row("db3", "the file alone, zstd", "sqlite3, zstd", packed, drive)
    whole = pathlib.Path(path).read_bytes()
    pathlib.Path(path).write_bytes(whole[:len(whole) * 9 // 10])
    cut_row("db3", "cut off", "sqlite3", path, drive)


def ros2_folder(folder, name, drive, version=5, mode="", parts=1):
    """A folder of databases. @return its path"""
    target = f"{folder}/{name}"
    os.makedirs(target)
    size = -(-len(drive.messages) // parts)
    files = [(f"{name}_{i}.db3", drive.messages[i * size:(i + 1) * size]) for i in range(parts)]
    for file, messages in files:
        containers.write_db3(f"{target}/{file}", messages, packed=mode == "MESSAGE")
        if mode == "FILE":
            database = pathlib.Path(f"{target}/{file}")
            pathlib.Path(f"{database}.zstd").write_bytes(containers.zstd(database.read_bytes()))
            database.unlink()
    ending = ".zstd" if mode == "FILE" else ""
    containers.write_metadata(target, "sqlite3", [(f + ending, m) for f, m in files], mode, version)
    return target


def try_ros2_folders(folder):
    drive = Drive("CDR")
    for variant, options in {**{f"metadata {v}": {"version": v} for v in (2, 4, 5, 8, 9)},
                             "three files": {"parts": 3}, "zstd by file": {"mode": "FILE"},
                             "zstd by message": {"mode": "MESSAGE"},
                             "zstd by file, two files": {"mode": "FILE", "parts": 2}}.items():
        name = "r_" + variant.replace(" ", "_").replace(",", "")
        target = ros2_folder(folder, name, drive, **options)
        read_row("ROS 2 folder", variant, "sqlite3, zstd", target, drive)
    target = f"{folder}/with_mcap"
    os.makedirs(target)
    if containers.write_mcap(containers.mcap_file(f"{target}/a.mcap", drive.messages, "zstd")):
        containers.write_metadata(target, "mcap", [("a.mcap", drive.messages)])
        read_row("ROS 2 folder", "of an MCAP", "@mcap/core", target, drive)


# --- messages ---
def layouts():
    """Layouts of points: name, a cloud for each scan."""
    every = XYZ + [("a", "<f8"), ("b", "i1"), ("c", "<i2"), ("d", "<i4"), ("e", "u1"), ("f", "<u2"),
                   ("g", "<u4")]
    padded = np.dtype({"names": ["x", "y", "z", "intensity", "ring"], "itemsize": 48,
                       "formats": ["<f4", "<f4", "<f4", "<f4", "<u2"], "offsets": [0, 4, 8, 16, 24]})
    backwards = np.dtype({"names": ["ring", "z", "y", "x"], "itemsize": 14,
                          "formats": ["<u2", "<f4", "<f4", "<f4"], "offsets": [0, 10, 6, 2]})
    many = XYZ + [("normal", "<f4", (3,)), ("rgb", "<u4")]
    double = [(name, "<f8") for name, _ in XYZ] + [("t", "<u4")]
    make = lambda fields, **more: [Cloud(made(fields, 40, seed), **more) for seed in range(SCANS)]
    holes = make(USUAL)
    for cloud in holes:
        for axis in "xyz":
            cloud.array[axis][::3] = np.nan
    holes = [Cloud(cloud.array, height=4) for cloud in holes]
    return {"x y z": make(XYZ), "intensity, ring, time": make(USUAL), "padding as in PCL": make(padded),
            "fields out of order, odd places": make(backwards), "all types": make(every),
            "several values a field": make(many), "float64": make(double),
            "organised": make(USUAL, height=4), "organised, rows padded":
                make(USUAL, height=4, row_padding=24), "organised with NaN": holes,
            "big-endian": make(every, big_endian=True), "row_step 0": make(USUAL, row_step=0)}


def scans_file(folder, form, messages):
    """The messages in a recording of that form, with poses. @return its path"""
    drive = Drive(form)
    messages = in_order([m for m in drive.messages if m[1] != CLOUD] + messages)
    if form == "ROS 1":
        containers.write_ros1(f"{folder}/s.bag", messages)
        return f"{folder}/s.bag"
    containers.write_db3(f"{folder}/s.db3", messages)
    return f"{folder}/s.db3"


def try_layouts(folder):
    import io  # pylint: disable=import-outside-toplevel

    class Given:
        def __init__(self, of):
            self.clouds = of

    for variant, of in layouts().items():
        if ROSBAG:
            messages = []
            for stamp, cloud in zip(STAMPS, of):
                buffer = io.BytesIO()
                cloud.genpy(stamp).serialize(buffer)
                messages.append(("/points", CLOUD, stamp, buffer.getvalue()))
            read_row("PointCloud2, ROS 1", variant, "sensor_msgs", scans_file(folder, "ROS 1", messages),
                     Given(of))
        bytes_of = cdr_messages([(CLOUD, c.value(t)) for t, c in zip(STAMPS, of)])
        read_row("PointCloud2, CDR", variant, "@foxglove/rosmsg2", scans_file(
            folder, "CDR", [("/points", CLOUD, t, b) for t, b in zip(STAMPS, bytes_of)]), Given(of))
        if variant in ("all types", "big-endian"):
            read_row("PointCloud2, big-endian CDR", variant, "Python", scans_file(folder, "CDR", [
                ("/points", CLOUD, t, c.bytes("CDR big-endian", t)) for t, c in zip(STAMPS, of)]),
                Given(of))


def try_livox(folder):
    kinds = [("offset_time", "<u4")] + XYZ + [("reflectivity", "u1"), ("tag", "u1"), ("line", "u1")]
    arrays = [made(kinds, 30, seed) for seed in range(SCANS)]

    class Given:
        clouds = [Cloud(array) for array in arrays]

    for form in ("ROS 1", "CDR", "CDR big-endian"):
        for kind in ("livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg"):
            if form == "ROS 1" and not ROSBAG:
                continue
            messages = [("/livox/lidar", kind, t, livox(form, t, array.tolist()))
                        for t, array in zip(STAMPS, arrays)]
            path = scans_file(folder, "ROS 1" if form == "ROS 1" else "CDR", messages)
            read_row("Livox, " + form, kind.split("/")[0], "Python", path, Given)


def try_poses(folder):
    """Each kind of message with poses, in both forms."""
    level = MOUNT @ turn(2, 0.2)
    for form in ("ROS 1", "CDR"):
        if form == "ROS 1" and not ROSBAG:
            continue
        by = "genpy" if form == "ROS 1" else "@foxglove/rosmsg2"
        scans = [("/points", CLOUD, t, cloud.bytes(form, t)) for t, cloud in zip(STAMPS, clouds())]
        message = lambda topic, kind, poses, frame="odom", child="lidar": (
            topic, kind, poses[0][0], of_value(form, kind, pose_value(kind, poses, frame, child)))
        static = lambda pose: message("/tf_static", "tf2_msgs/TFMessage", [(START_NS, pose)],
                                      "base_link", "lidar")
        each = lambda kind, child="lidar", topic="/pose": [
            message(topic, kind, [(t, body(t))], child=child) for t in BETWEEN]
        tf = each("tf2_msgs/TFMessage", "base_link", "/tf")
        mounted = [body(t) @ level for t in STAMPS]
        plain = [body(t) for t in STAMPS]
        kinds = {"Odometry": (each(ODOMETRY), plain),
                 "Odometry of the body, tf_static":
                     (each(ODOMETRY, "base_link") + [static(level)], mounted),
                 "PoseStamped": (each("geometry_msgs/PoseStamped"), plain),
                 "PoseWithCovarianceStamped":
                     (each("geometry_msgs/PoseWithCovarianceStamped"), plain),
                 "TransformStamped": (each("geometry_msgs/TransformStamped"), plain),
                 "Path": ([message("/path", "nav_msgs/Path", [(t, body(t)) for t in BETWEEN])], plain),
                 "tf": (each("tf2_msgs/TFMessage", topic="/tf"), plain),
                 "tf and tf_static": (tf + [static(level)], mounted),
                 "tf and tf_static, which comes last":
                     (tf + [message("/tf_static", "tf2_msgs/TFMessage", [(BETWEEN[-1], level)],
                                    "base_link", "lidar")], mounted)}
        for variant, (poses, expected) in kinds.items():
            messages = in_order(poses + scans)
            path = f"{folder}/p.bag" if form == "ROS 1" else f"{folder}/p.db3"
            (containers.write_ros1 if form == "ROS 1" else containers.write_db3)(path, messages)
            TABLE.say("poses, " + form, variant, by, "read",
                      holds(asked("sequence", path), [c.array for c in clouds()], expected))
        if form == "ROS 1":
            echo_row(folder, in_order(each(ODOMETRY) + scans))


def echo_row(folder, messages):
    """What `rostopic echo -p` makes of odometry is a pose file beside the same bag."""
    containers.write_ros1(f"{folder}/e.bag", messages)
    try:
        done = subprocess.run(["rostopic", "echo", "-b", f"{folder}/e.bag", "-p", "/pose"],
                              capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return TABLE.say("poses, file", "csv of rostopic echo -p", "rostopic", "read",
                         "no python3-rostopic")
    pathlib.Path(f"{folder}/e.csv").write_text(done.stdout)
    answer = asked("sequence", f"{folder}/e.bag", f"poses={folder}/e.csv")
    TABLE.say("poses, file", "csv of rostopic echo -p", "rostopic", "read",
              holds(answer, [c.array for c in clouds()], POSES))


def main():
    parts = [try_ros1]
    if has_npm():
        parts += [try_mcap, try_db3, try_ros2_folders, try_layouts, try_livox, try_poses]
    else:
        TABLE.say("ROS 2", "all", "npm's packages", "both", "no @mcap/core, @foxglove/rosmsg and "
                  "@foxglove/rosmsg2-serialization in NODE_PATH")
    for part in parts:
        with tempfile.TemporaryDirectory() as folder:
            part(folder)
    return TABLE.finish()


if __name__ == "__main__":
    os.environ["LC_ALL"] = "C"
    sys.exit(main())
