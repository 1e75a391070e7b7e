#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the likeliest mistakes with each reader, and looks at what the program says.

    mistakes.py PROGRAM [--show]    --show prints each message

Each mistake ends with exit code 2 and a message that says what is wrong, where, and what to do: the
words that have to be in it stand beside the mistake. Nothing but Python itself is needed.
"""
import os
import pathlib
import sqlite3
import struct
import subprocess
import sys
import tempfile

from recipe_data import (Message, cloud_message, livox_message, mcap, odometry_message, ros1_bag,
                         tf_message)

START = 1_700_000_000_000_000_000
STEP = 100_000_000
STAMPS = [START + i * STEP for i in range(3)]
POINTS = [(5.0 + i, 0.5 * i, 0.1 * i, 0.5) for i in range(8)]
HERE = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
CLOUD, ODOMETRY, TF = "sensor_msgs/PointCloud2", "nav_msgs/Odometry", "tf2_msgs/TFMessage"
CLOUD2, TF2 = "sensor_msgs/msg/PointCloud2", "tf2_msgs/msg/TFMessage"
ROW = "1 0 0 0 0 1 0 0 0 0 1 0\n"
LFS = "version https://git-lfs.github.com/spec/v1\noid sha256:0123456789abcdef\nsize 123456\n"


# --- files ---
def clouds(topic="/points", kind=CLOUD, ros1=True):
    return [(topic, kind, t, cloud_message(ros1, t, POINTS)) for t in STAMPS]


def odometry(topic="/odom"):
    return [(topic, ODOMETRY, t, odometry_message(t, HERE)) for t in STAMPS]


def imu():
    return [("/imu", "sensor_msgs/Imu", t, bytes(300)) for t in STAMPS]


def other_body():
    """Odometry of a body that nothing says how the sensor stands on."""
    def message(stamp):
        one = Message(ros1=True)
        one.header(stamp, "odom")
        one.text("base_link")
        one.put("d", 0, 0, 0, 0, 0, 0, 1, *[0.0] * 78)
        return one.done()
    return [("/odom", ODOMETRY, t, message(t)) for t in STAMPS]


def framed(ros1, frames):
    """Clouds whose frame changes."""
    def message(stamp, frame):
        return cloud_message(ros1, stamp, POINTS).replace(b"velodyne", frame)
    return [("/points", CLOUD2, t, message(t, frame)) for t, frame in zip(STAMPS, frames)]


def tf(parent="odom", child="velodyne"):
    return [("/tf", TF2, t, tf_message(t, parent, child, HERE)) for t in STAMPS]


def bag(*parts):
    return ros1_bag(sorted(sum(parts, []), key=lambda message: message[2]))


def mcap_of(*parts):
    return mcap(sorted(sum(parts, []), key=lambda message: message[2]))


def database(tables=True):
    with tempfile.TemporaryDirectory() as folder:
        path = folder + "/a.db3"
        base = sqlite3.connect(path)
        if tables:
            base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT,"
                         " serialization_format TEXT, offered_qos_profiles TEXT)")
            base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER,"
                         " timestamp INTEGER, data BLOB)")
            base.execute("INSERT INTO topics VALUES(1, '/points', ?, 'cdr', '')", (CLOUD2,))
            for t in STAMPS:
                base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)",
                             (t, cloud_message(False, t, POINTS)))
        else:
            base.execute("CREATE TABLE places(name TEXT)")
        base.commit()
        base.close()
        return pathlib.Path(path).read_bytes()


def metadata(storage="sqlite3", packed="", file="a.db3"):
    return (f"rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: {storage}\n"
            f"  compression_format: \"{packed}\"\n  compression_mode: \"{'FILE' if packed else ''}\"\n"
            f"  relative_file_paths:\n    - {file}\n")


def pcd(fields="x y z intensity", sizes="4 4 4 4", types="F F F F", data="binary", points=2, body=None):
    head = (f"VERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {types}\nCOUNT {' '.join('1' * len(fields.split()))}\n"
            f"WIDTH {points}\nHEIGHT 1\nPOINTS {points}\nDATA {data}\n").encode()
    return head + (struct.pack("<8f", 1, 2, 3, 0, 4, 5, 6, 0) if body is None else body)


def ply(properties, body, form="binary_little_endian", count=2):
    head = f"ply\nformat {form} 1.0\nelement vertex {count}\n"
    return (head + "".join(f"property {p}\n" for p in properties) + "end_header\n").encode() + body


XYZ = ["float x", "float y", "float z"]


def las(version=4, point_format=6, points=2, size=30, body=None):
    head = bytearray(375)
    head[:4], head[24], head[25] = b"LASF", 1, version
    struct.pack_into("<HIIBH", head, 94, 375, 375, 0, point_format, size)
    struct.pack_into("<6d", head, 131, 0.001, 0.001, 0.001, 0, 0, 0)
    struct.pack_into("<Q", head, 247, points)
    return bytes(head) + (bytes(points * size) if body is None else body)


def npy(descr, shape, body):
    text = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}"
    text += " " * (-(len(text) + 11) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode() + body


def npz(*names):
    import io  # pylint: disable=import-outside-toplevel
    import zipfile  # pylint: disable=import-outside-toplevel
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in names:
            archive.writestr(name + ".npy", npy("'<f4'", "(2, 4)", bytes(32)))
    return buffer.getvalue()


def bins(count=3, body=struct.pack("<8f", 5, 2, 3, 0, 4, 5, 6, 0)):
    return {f"s/{i:06d}.bin": body for i in range(count)}


def scan(name, content):
    """A folder of one scan with a pose."""
    return {f"s/{name}": content, "s/poses.txt": ROW}


def timed(times):
    """Three scans of x y z and a time as float32, with poses by time."""
    rows = b"".join(struct.pack("<4f", 5 + i, i, 1, t) for i, t in enumerate(times))
    return {**bins(body=rows), "s/times.txt": "1000\n1000.1\n1000.2\n", "s/poses.txt": "".join(
        f"{1000 + 0.1 * (i - 1)} {i} 0 0 0 0 0 1\n" for i in range(5))}


WITH_TIME = ["--point-layout", "x y z time"]
THREE = {**bins(), "s/poses.txt": 3 * ROW}
BY_TIME = {**bins(), "s/times.txt": "1000\n1000.1\n1000.2\n"}


# Reader, mistake, files, arguments, words of the message.
MISTAKES = [
    ("bag", "only its first bytes were copied", {"a.bag": bag(clouds(), odometry())[:4000]}, ["a.bag"],
     ["a.bag", "truncated", "Copy it again"]),
    ("bag", "a web page under its name", {"a.bag": "<!DOCTYPE html>"}, ["a.bag"],
     ["a.bag", "does not begin as a recording", "Copy it again"]),
    ("bag", "no scans in it", {"a.bag": bag(imu())}, ["a.bag"],
     ["no topic has scans", "sensor_msgs/PointCloud2", "/imu (sensor_msgs/Imu, 3 messages)"]),
    ("bag", "no poses in it", {"a.bag": bag(clouds())}, ["a.bag"],
     ["there are no poses", "/points", "--poses FILE", "KISS-ICP", "--poses identity"]),
    ("bag", "poses of another frame", {"a.bag": bag(clouds(), other_body())}, ["a.bag"],
     ["'base_link'", "'velodyne'", "--T-sensor x,y,z,qx,qy,qz,qw"]),
    ("bag", "two topics with scans", {"a.bag": bag(clouds(), clouds("/rear"), odometry())}, ["a.bag"],
     ["several topics with scans", "/points", "/rear", "--topic"]),
    ("bag", "still recording, without poses", {"a.bag.active": bag(clouds())}, ["a.bag.active"],
     ["there are no poses"]),
    ("mcap", "an empty file", {"a.mcap": ""}, ["a.mcap"], ["a.mcap", "does not begin", "Copy it again"]),
    ("mcap", "only its first bytes were copied", {"a.mcap": mcap_of(clouds(ros1=False, kind=CLOUD2))[:30]},
     ["a.mcap"], ["a.mcap", "no message", "truncated"]),
    ("mcap", "packets of a driver", {"a.mcap": mcap_of(
        [("/packets", "velodyne_msgs/msg/VelodyneScan", t, bytes(99)) for t in STAMPS])}, ["a.mcap"],
     ["no topic has scans", "velodyne_msgs/VelodyneScan", "replay"]),
    ("mcap", "the frame of the points changes", {"a.mcap": mcap_of(
        framed(False, [b"velodyne", b"velodyne", b"velodxne"]), tf())}, ["a.mcap"],
     ["message 2", "'velodxne'", "'velodyne'", "Filter"]),
    ("mcap", "tf does not know the sensor", {"a.mcap": mcap_of(
        clouds(ros1=False, kind=CLOUD2), tf(child="base_link"))}, ["a.mcap"],
     ["no poses", "'velodyne'", "--poses"]),
    ("ROS 2", "two recordings without metadata.yaml", {"d/a.db3": database(), "d/b.db3": database()},
     ["d"], ["metadata.yaml", "a.db3", "ros2 bag reindex"]),
    ("ROS 2", "the database was not copied", {"d/metadata.yaml": metadata()}, ["d"],
     ["a.db3", "Copy"]),
    ("ROS 2", "another storage", {"d/metadata.yaml": metadata("my_storage")}, ["d"],
     ["'my_storage'", "sqlite3 or mcap", "ros2 bag convert"]),
    ("ROS 2", "packed in another way", {"d/metadata.yaml": metadata(packed="lz4"), "d/a.db3": database()},
     ["d"], ["'lz4'", "zstd", "ros2 bag convert"]),
    ("ROS 2", "a database of something else", {"a.db3": database(tables=False)}, ["a.db3"],
     ["a.db3", "'topics'", "`ros2 bag record`"]),
    ("ROS 2", "still recording (-wal)", {"a.db3": database(), "a.db3-wal": bytes(100)}, ["a.db3"],
     ["a.db3-wal", "sqlite3"]),
    ("pcd", "a pointer of git-lfs", scan("a.pcd", LFS), ["s"], ["a.pcd", "git-lfs"]),
    ("pcd", "cut off", scan("a.pcd", pcd()[:-10]), ["s"], ["a.pcd", "2 points", "truncated", "--skip-bad-scans"]),
    ("pcd", "latitude and longitude", scan("a.pcd", pcd("lat lon z", "4 4 4", "F F F")), ["s"],
     ["a.pcd", "'x'", "lat"]),
    ("pcd", "decimal commas", scan("a.pcd", pcd("x y z", "4 4 4", "F F F", "ascii", 1, b"1,5 2,5 3,5\n")),
     ["s"], ["a.pcd", "line", "'1,5'", "point"]),
    ("pcd", "float16", scan("a.pcd", pcd("x y z", "2 2 2", "F F F")), ["s"], ["a.pcd", "SIZE", "4", "8"]),
    ("ply", "a mesh without points", scan("a.ply", b"ply\nformat ascii 1.0\nelement face 0\n"
                                          b"property list uchar int v\nend_header\n"), ["s"],
     ["a.ply", "vertex"]),
    ("ply", "cut off", scan("a.ply", ply(XYZ, bytes(20))), ["s"], ["a.ply", "truncated", "--skip-bad-scans"]),
    ("ply", "no z", scan("a.ply", ply(["float x", "float y"], bytes(16))), ["s"], ["a.ply", "'z'", "x"]),
    ("ply", "a list in each point", scan("a.ply", ply(XYZ + ["list uchar int n"], bytes(26))), ["s"],
     ["a.ply", "line", "no list"]),
    ("ply", "no PLY file", scan("a.ply", b"solid cube\nfacet normal 0 0 1\n"), ["s"], ["a.ply", "ply"]),
    ("las", "LAZ", scan("a.laz", b"LASF"), ["s"], ["laz", "laszip"]),
    ("las", "LAZ under the name .las", scan("a.las", las(point_format=128 + 6)), ["s"],
     ["a.las", "LAZ", "laszip"]),
    ("las", "cut off", scan("a.las", las(points=5, body=bytes(60))), ["s"], ["a.las", "5", "truncated"]),
    ("las", "not a LAS file", scan("a.las", b"x,y,z\n1,2,3\n"), ["s"], ["a.las", "LASF"]),
    ("las", "an unknown format of points", scan("a.las", las(point_format=11)), ["s"],
     ["a.las", "11", "0 to 10"]),
    ("bin", "five numbers a point", scan("0.bin", bytes(20 * 3)), ["s"],
     ["0.bin", "60 bytes", "16", "--point-layout"]),
    ("bin", "a layout that does not fit", {**scan("0.bin", bytes(32))},
     ["s", "--point-layout", "x y z t:f8"], ["0.bin", "32 bytes", "20"]),
    ("bin", "a layout between commas", scan("0.bin", bytes(32)), ["s", "--point-layout", "x,y,z,intensity"],
     ["x,y,z,intensity", "blanks", "x y z"]),
    ("bin", "a layout without x", scan("0.bin", bytes(32)), ["s", "--point-layout", "a b c d"],
     ["'x'", "x y z"]),
    ("bin", "an empty file", scan("0.bin", b""), ["s"], ["0.bin", "no point"]),
    ("npy", "an array of two columns", scan("a.npy", npy("'<f4'", "(4, 2)", bytes(32))), ["s"],
     ["a.npy", "4 x 2", "x"]),
    ("npy", "Python objects", scan("a.npy", npy("'|O'", "(4,)", b"\x80\x04")), ["s"],
     ["a.npy", "'|O'", "objects of Python"]),
    ("npy", "cut off", scan("a.npy", npy("'<f4'", "(4, 4)", bytes(20))), ["s"], ["a.npy", "20 bytes", "truncated", "again"]),
    ("npy", "one row of numbers", scan("a.npy", npy("'<f4'", "(16,)", bytes(64))), ["s"],
     ["a.npy", "16", "N x"]),
    ("npz", "several arrays", scan("a.npz", npz("left", "right")), ["s"],
     ["a.npz", "left", "right", "points or arr_0"]),
    ("npz", "cut off", scan("a.npz", npz("points")[:-30]), ["s"], ["a.npz", "truncated"]),
    ("poses", "none there", bins(), ["s"], ["poses.txt", "--poses", "KISS-ICP", "identity"]),
    ("poses", "too few", {**bins(), "s/poses.txt": 2 * ROW}, ["s"], ["2 poses", "3 scans"]),
    ("poses", "rows of five numbers", {**bins(), "s/poses.txt": 3 * "1 2 3 4 5\n"}, ["s"],
     ["poses.txt: line 1", "5 numbers", "12 (KITTI", "list pose-formats"]),
    ("poses", "decimal commas", {**bins(), "s/poses.txt": 3 * ROW.replace("1 ", "1,5 ")}, ["s"],
     ["poses.txt: line 1", "decimal", "write points"]),
    ("poses", "a quaternion of zeros", {**BY_TIME, "s/poses.txt": "".join(
        f"100{i} 0 0 0 0 0 0 0\n" for i in range(3))}, ["s"], ["poses.txt: line 1", "quaternion", "length"]),
    ("poses", "another clock", {**BY_TIME, "s/poses.txt": "".join(
        f"{5000 + i} 0 0 0 0 0 0 1\n" for i in range(3))}, ["s"],
     ["3 of 3 scans have no pose", "1000", "5000", "--time-offset 4000"]),
    ("poses", "two poses of one time", {**BY_TIME, "s/poses.txt": "1000 0 0 0 0 0 0 1\n1000 9 0 0 0 0 0 1\n"},
     ["s"], ["poses.txt: line 2", "time", "9 m apart"]),
    ("--deskew", "points without times", THREE, ["s", "--deskew"],
     ["--deskew needs the time of each point", "found", "intensity", "leave --deskew out"]),
    ("--deskew", "all times the same", timed([3, 3, 3, 3]), ["s", "--deskew", *WITH_TIME],
     ["same time", "'time'", "Leave --deskew out"]),
    ("--deskew", "ticks of a timer", timed([0, 3e12, 6e12]), ["s", "--deskew", *WITH_TIME],
     ["'time'", "--point-time-unit SECONDS"]),
    ("--deskew", "float32 since 1970", timed([1.7e9, 1.7e9 + 256]),
     ["s", "--deskew", *WITH_TIME, "--point-time-unit", "ms"], ["float32", "too coarse", "float64"]),
    ("--deskew", "an unknown unit", timed([0, 0.05, 0.1]),
     ["s", "--deskew", *WITH_TIME, "--point-time-unit", "sec"], ["--point-time-unit sec", "s, ms, us, ns"]),
    ("--deskew", "points a minute after their scan", timed([0, 0.05, 60]),
     ["s", "--deskew", *WITH_TIME, "--point-time-unit", "s"], ["0.bin", "60", "--point-time-unit"]),
    ("--T-sensor", "six numbers", THREE, ["s", "--T-sensor", "0,0,1,0,0,0"],
     ["--T-sensor", "not seven numbers", "x,y,z,qx,qy,qz,qw"]),
    ("--T-sensor", "no such file", THREE, ["s", "--T-sensor", "mount.txt"], ["mount.txt", "x,y,z,qx,qy,qz,qw"]),
    ("--T-sensor", "degrees for a quaternion", THREE, ["s", "--T-sensor", "0,0,1,0,0,90,0"],
     ["--T-sensor", "quaternion", "length"]),
    ("--T-sensor", "a file with a 3 x 3 matrix", {**THREE, "mount.txt": "1 0 0\n0 1 0\n0 0 1\n"},
     ["s", "--T-sensor", "mount.txt"], ["mount.txt", "9 numbers", "3 x 4"]),
    ("--T-sensor", "poses that are those of tf", {"a.mcap": mcap_of(clouds(ros1=False, kind=CLOUD2), tf())},
     ["a.mcap", "--T-sensor", "0,0,1,0,0,0,1"], ["tf", "Leave it out"]),
    ("--topic", "a slip of the pen", {"a.bag": bag(clouds(), odometry())}, ["a.bag", "--topic", "/pionts"],
     ["no such topic", "Did you mean '/points'", "/odom"]),
    ("--topic", "a topic without scans", {"a.bag": bag(clouds(), odometry())}, ["a.bag", "--topic", "/odom"],
     ["is no topic with scans", "nav_msgs/Odometry"]),
    ("--topic", "of a folder of files", THREE, ["s", "--topic", "/points"], ["--topic", "recording"]),
    ("--topic", "poses from a topic without poses", {"a.bag": bag(clouds(), imu())},
     ["a.bag", "--pose-topic", "/imu"], ["--pose-topic /imu", "no topic with poses", "sensor_msgs/Imu"]),
    ("--topic", "poses by a file and a topic", {"a.bag": bag(clouds(), odometry()), "p.txt": ROW},
     ["a.bag", "--poses", "p.txt", "--pose-topic", "/odom"], ["--pose-topic", "--poses"]),
    ("Livox", "a cut message", {"a.bag": bag([("/livox", "livox_ros_driver/CustomMsg", t,
                                               livox_message(t, POINTS)[:-20]) for t in STAMPS])},
     ["a.bag", "--poses", "identity"], ["/livox", "message 0", "truncated"]),
]


def outcome(program, files, arguments):
    """The exit code and the message of one mistake."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content.encode() if isinstance(content, str) else content)
        done = subprocess.run([program, "clean", *arguments, "--method", "noop", "-o", "map.pcd", "--quiet"],
                              cwd=folder, capture_output=True, text=True, timeout=60, check=False)
        left = sorted(path.name for path in pathlib.Path(folder).iterdir())
        expected = sorted({name.split("/")[0] for name in files})
        return done.returncode, done.stderr.strip(), left == expected


def main():
    program = os.path.abspath(sys.argv[1])
    failures = 0
    for reader, mistake, files, arguments, words in MISTAKES:
        code, message, clean = outcome(program, files, arguments)
        missing = [word for word in words if word not in message]
        good = code == 2 and message.startswith("raymoval: ") and clean and not missing
        failures += not good
        if "--show" in sys.argv[2:] or not good:
            print(f"{reader}: {mistake}: exit {code}" + ("" if good else f"; missing {missing}") +
                  ("" if clean else "; leaves files") + f"\n    {message}")
    print(f"mistakes: {len(MISTAKES) - failures} of {len(MISTAKES)} are told as they should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
