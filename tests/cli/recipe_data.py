#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the small files that the recipes of docs/recipes/ begin with, out of a simulated drive.

Usage: recipe_data.py DRIVE RECIPE FOLDER

DRIVE is what `raymoval simulate` wrote. FOLDER gets the files by the names of the recipe's page.
Nothing but Python itself is needed.
"""
import math
import pathlib
import struct
import sys

START_NS = 1_700_000_000_000_000_000
PERIOD_NS = 100_000_000


# --- the drive ---
def product(a, b):
    """Of two poses, each a list of 3 rows of 4."""
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0.0) for j in range(4)]
            for i in range(3)]


def inverse(a):
    turn = [[a[j][i] for j in range(3)] for i in range(3)]
    return [turn[i] + [-sum(turn[i][k] * a[k][3] for k in range(3))] for i in range(3)]


def rows_of(numbers):
    return [numbers[0:4], numbers[4:8], numbers[8:12]]


class Drive:
    """Scans as lists of (x, y, z, intensity) and the pose of the sensor at each."""

    def __init__(self, folder):
        folder = pathlib.Path(folder)
        calibration = [line.split() for line in (folder / "calib.txt").read_text().splitlines()]
        camera_lidar = rows_of([float(n) for n in next(row for row in calibration if row[0] == "Tr:")[1:]])
        self.poses = [product(inverse(camera_lidar),
                              product(rows_of([float(n) for n in line.split()]), camera_lidar))
                      for line in (folder / "poses.txt").read_text().splitlines()]
        self.scans = [list(struct.iter_unpack("<4f", path.read_bytes()))
                      for path in sorted((folder / "velodyne").iterdir())]
        self.labels = [[word & 0xFFFF for word, in struct.iter_unpack("<I", path.read_bytes())]
                       for path in sorted((folder / "labels").iterdir())]
        self.stamps = [START_NS + i * PERIOD_NS for i in range(len(self.scans))]


def quaternion(pose):
    """x, y, z, w of a turn of less than half a revolution, as a drive's are."""
    w = math.sqrt(max(0.0, 1.0 + pose[0][0] + pose[1][1] + pose[2][2])) / 2.0
    if w < 0.1:
        raise SystemExit("recipe_data.py: a scan looks back, which these few lines do not know")
    return [(pose[2][1] - pose[1][2]) / (4 * w), (pose[0][2] - pose[2][0]) / (4 * w),
            (pose[1][0] - pose[0][1]) / (4 * w), w]


def position(pose):
    return [pose[0][3], pose[1][3], pose[2][3]]


def moved(pose, points):
    return [tuple(sum(pose[i][k] * p[k] for k in range(3)) + pose[i][3] for i in range(3)) + (p[3],)
            for p in points]


def tum(drive):
    return "".join(f"{stamp // 10**9}.{stamp % 10**9:09d} "
                   + " ".join(repr(v) for v in position(pose) + quaternion(pose)) + "\n"
                   for stamp, pose in zip(drive.stamps, drive.poses))


def kitti(drive):
    return "".join(" ".join(repr(v) for row in pose for v in row) + "\n" for pose in drive.poses)


def pcd(points):
    """With a ring, so that there is a field besides the usual ones."""
    head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity ring\nSIZE 4 4 4 4 2\nTYPE F F F F U\n"
            f"COUNT 1 1 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
            f"POINTS {len(points)}\nDATA binary\n")
    return head.encode() + b"".join(struct.pack("<4fH", *p, i % 16) for i, p in enumerate(points))


# --- messages ---
class Message:
    """A message under way: ROS 1 packs its numbers, CDR aligns them from its head on."""

    def __init__(self, ros1):
        self.ros1 = ros1
        self.body = bytearray()

    def put(self, code, *values):
        for value in values:
            size = struct.calcsize("<" + code)
            if not self.ros1:
                self.body += bytes(-len(self.body) % size)
            self.body += struct.pack("<" + code, value)

    def text(self, value):
        value = value.encode() + (b"" if self.ros1 else b"\0")
        self.put("I", len(value))
        self.body += value

    def header(self, stamp, frame):
        if self.ros1:
            self.put("I", 0)
        self.put("I", stamp // 10**9, stamp % 10**9)
        self.text(frame)

    def done(self):
        return bytes(self.body) if self.ros1 else b"\0\1\0\0" + bytes(self.body)


def cloud_message(ros1, stamp, points):
    message = Message(ros1)
    message.header(stamp, "velodyne")
    message.put("I", 1, len(points))
    fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4)]
    message.put("I", len(fields))
    for name, offset, kind in fields:
        message.text(name)
        message.put("I", offset)
        message.put("B", kind)
        message.put("I", 1)
    data = b"".join(struct.pack("<4fHxx", *p, i % 16) for i, p in enumerate(points))
    message.put("B", 0)
    message.put("I", 20, len(data), len(data))
    message.body += data
    message.put("B", 1)
    return message.done()


def odometry_message(stamp, pose):
    message = Message(ros1=True)
    message.header(stamp, "odom")
    message.text("velodyne")
    message.put("d", *position(pose), *quaternion(pose), *[0.0] * 36, *[0.0] * 42)
    return message.done()


def tf_message(stamp, parent, child, pose):
    message = Message(ros1=False)
    message.put("I", 1)
    message.header(stamp, parent)
    message.text(child)
    message.put("d", *position(pose), *quaternion(pose))
    return message.done()


def livox_message(stamp, points):
    message = Message(ros1=True)
    message.header(stamp, "livox_frame")
    message.put("Q", stamp)
    message.put("I", len(points))
    message.put("B", 0, 0, 0, 0)
    message.put("I", len(points))
    message.body += b"".join(struct.pack("<I3f3B", i * 99_000_000 // len(points), *p[:3],
                                         min(255, int(255 * p[3])), 16, i % 6)
                             for i, p in enumerate(points))
    return message.done()


# --- recordings ---
def bag_record(fields, data):
    head = b"".join(struct.pack("<I", len(name) + 1 + len(value)) + name.encode() + b"=" + value
                    for name, value in fields.items())
    return struct.pack("<I", len(head)) + head + struct.pack("<I", len(data)) + data


def ros1_bag(messages):
    """@param messages of (topic, type, stamp, bytes). One chunk that is not packed."""
    topics = list(dict.fromkeys((topic, kind) for topic, kind, _, _ in messages))
    connections = []
    for number, (topic, kind) in enumerate(topics):
        about = {"topic": topic.encode(), "type": kind.encode(), "md5sum": b"*", "message_definition": b""}
        data = b"".join(struct.pack("<I", len(k) + 1 + len(v)) + k.encode() + b"=" + v for k, v in about.items())
        connections.append(bag_record({"op": b"\7", "conn": struct.pack("<I", number), "topic": topic.encode()}, data))
    chunk = bytearray(b"".join(connections))
    index = {number: [] for number in range(len(topics))}
    time_of = lambda stamp: struct.pack("<II", stamp // 10**9, stamp % 10**9)
    for topic, kind, stamp, data in messages:
        number = topics.index((topic, kind))
        index[number].append(time_of(stamp) + struct.pack("<I", len(chunk)))
        chunk += bag_record({"op": b"\2", "conn": struct.pack("<I", number), "time": time_of(stamp)}, data)
    body = bag_record({"op": b"\5", "compression": b"none", "size": struct.pack("<I", len(chunk))}, bytes(chunk))
    for number, entries in index.items():
        body += bag_record({"op": b"\4", "ver": struct.pack("<I", 1), "conn": struct.pack("<I", number),
                            "count": struct.pack("<I", len(entries))}, b"".join(entries))
    start = b"#ROSBAG V2.0\n"
    first = len(start) + 4096
    def head(position):
        fields = {"op": b"\3", "index_pos": struct.pack("<Q", position),
                  "conn_count": struct.pack("<I", len(topics)), "chunk_count": struct.pack("<I", 1)}
        return bag_record(fields, b" " * (4096 - len(bag_record(fields, b""))))
    stamps = [stamp for _, _, stamp, _ in messages]
    info = bag_record({"op": b"\6", "ver": struct.pack("<I", 1), "chunk_pos": struct.pack("<Q", first),
                       "start_time": time_of(min(stamps)), "end_time": time_of(max(stamps)),
                       "count": struct.pack("<I", len(topics))},
                      b"".join(struct.pack("<II", n, len(e)) for n, e in index.items()))
    return start + head(first + len(body)) + body + b"".join(connections) + info


def mcap(messages):
    """The same in the form of ROS 2, without chunks and without a summary."""
    text = lambda value: struct.pack("<I", len(value)) + value.encode()
    record = lambda opcode, data: struct.pack("<BQ", opcode, len(data)) + data
    magic = b"\x89MCAP0\r\n"
    topics = list(dict.fromkeys((topic, kind) for topic, kind, _, _ in messages))
    out = bytearray(magic + record(1, text("ros2") + text("recipe_data.py")))
    for number, (topic, kind) in enumerate(topics, 1):
        out += record(3, struct.pack("<H", number) + text(kind) + text("ros2msg") + struct.pack("<I", 0))
        out += record(4, struct.pack("<HH", number, number) + text(topic) + text("cdr") + struct.pack("<I", 0))
    for sequence, (topic, kind, stamp, data) in enumerate(messages):
        out += record(5, struct.pack("<HIQQ", topics.index((topic, kind)) + 1, sequence, stamp, stamp) + data)
    return bytes(out + record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + magic)


# --- recipes ---
def world_frame(drive, folder):
    (folder / "world").mkdir()
    for stamp, pose, scan in zip(drive.stamps, drive.poses, drive.scans):
        (folder / "world" / f"{stamp // 10**9}.{stamp % 10**9:09d}.pcd").write_bytes(pcd(moved(pose, scan)))
    (folder / "trajectory.txt").write_text(tum(drive))


def kiss_icp(drive, folder):
    (folder / "scans").mkdir()
    (folder / "results/latest").mkdir(parents=True)
    for i, scan in enumerate(drive.scans):
        (folder / "scans" / f"{i:06d}.pcd").write_bytes(pcd(scan))
    (folder / "results/latest/scans_poses_kitti.txt").write_text(kitti(drive))


def fast_lio(drive, folder):
    (folder / "PCD").mkdir()
    for i, (pose, scan) in enumerate(zip(drive.poses, drive.scans), 1):
        (folder / "PCD" / f"scans_{i}.pcd").write_bytes(pcd(moved(pose, scan)))
    (folder / "trajectory.txt").write_text(tum(drive))


def clouds(drive, ros1, kind):
    return [("/points", kind, stamp, cloud_message(ros1, stamp, scan))
            for stamp, scan in zip(drive.stamps, drive.scans)]


def in_order(messages):
    return sorted(messages, key=lambda message: message[2])


def ros1_odometry(drive, folder):
    odometry = [("/odom", "nav_msgs/Odometry", stamp, odometry_message(stamp, pose))
                for stamp, pose in zip(drive.stamps, drive.poses)]
    (folder / "drive.bag").write_bytes(
        ros1_bag(in_order(odometry + clouds(drive, True, "sensor_msgs/PointCloud2"))))


def doals(drive, folder):
    """A recording of which every fourth scan is labelled, beside it."""
    ros1_odometry(drive, folder)
    (folder / "drive.bag").rename(folder / "bag.bag")
    rows = [[stamp] + [i for i, label in enumerate(labels) if label >= 252]
            for stamp, labels in zip(drive.stamps[::4], drive.labels[::4])]
    (folder / "indices.csv").write_text("".join(",".join(map(str, row)) + "\n" for row in rows))


def ros2_tf(drive, folder):
    level = [[1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.2]]
    tf = "tf2_msgs/msg/TFMessage"
    messages = [("/tf_static", tf, START_NS, tf_message(START_NS, "base_link", "velodyne", level))]
    for stamp, pose in zip(drive.stamps, drive.poses):
        messages.append(("/tf", tf, stamp, tf_message(stamp, "odom", "base_link", product(pose, inverse(level)))))
    messages += clouds(drive, False, "sensor_msgs/msg/PointCloud2")
    (folder / "drive.mcap").write_bytes(mcap(in_order(messages)))


def glim(drive, folder):
    (folder / "dump").mkdir()
    (folder / "dump/traj_lidar.txt").write_text(tum(drive))
    (folder / "drive.mcap").write_bytes(mcap(clouds(drive, False, "sensor_msgs/msg/PointCloud2")))


def livox(drive, folder):
    (folder / "livox.bag").write_bytes(ros1_bag([
        ("/livox/lidar", "livox_ros_driver/CustomMsg", stamp, livox_message(stamp, scan))
        for stamp, scan in zip(drive.stamps, drive.scans)]))
    (folder / "trajectory.txt").write_text(tum(drive))


EARTH_RADIUS, LATITUDE, LONGITUDE = 6378137.0, 49.0, 8.4


def kitti_raw(drive, folder):
    """oxts/data by the formulas of KITTI's development kit, turned round."""
    (folder / "drive/velodyne_points/data").mkdir(parents=True)
    (folder / "drive/oxts/data").mkdir(parents=True)
    velo_imu = [[1.0, 0.0, 0.0, -0.8], [0.0, 1.0, 0.0, 0.3], [0.0, 0.0, 1.0, -0.8]]
    (folder / "calib_imu_to_velo.txt").write_text("R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n")
    scale = math.cos(math.radians(LATITUDE)) * EARTH_RADIUS
    start = scale * math.log(math.tan(math.radians(90.0 + LATITUDE) / 2.0))
    for i, (pose, scan) in enumerate(zip(drive.poses, drive.scans)):
        name = f"drive/velodyne_points/data/{i:010d}.bin"
        (folder / name).write_bytes(b"".join(struct.pack("<4f", *p) for p in scan))
        imu = product(pose, velo_imu)
        x, y, z = position(imu)
        row = [math.degrees(2.0 * math.atan(math.exp((start + y) / scale))) - 90.0,
               LONGITUDE + math.degrees(x / scale), 110.0 + z, math.atan2(imu[2][1], imu[2][2]),
               math.asin(-imu[2][0]), math.atan2(imu[1][0], imu[0][0])]
        (folder / f"drive/oxts/data/{i:010d}.txt").write_text(" ".join(map(repr, row + [0.0] * 24)))


def hdl_graph_slam(drive, folder):
    for i, (pose, scan) in enumerate(zip(drive.poses, drive.scans)):
        keyframe = folder / f"dump/{i:06d}"
        keyframe.mkdir(parents=True)
        (keyframe / "cloud.pcd").write_bytes(pcd(scan))
        matrix = "\n".join(" ".join(map(repr, row)) for row in pose + [[0.0, 0.0, 0.0, 1.0]])
        (keyframe / "data").write_text(f"stamp {i} 0\nestimate\n{matrix}\nodom\n{matrix}\naccum_distance {i}\nid {i}\n")


RECIPES = {"kitti-raw": kitti_raw, "hdl-graph-slam": hdl_graph_slam, "world-frame": world_frame, "kiss-icp": kiss_icp, "fast-lio": fast_lio, "glim": glim,
           "ros1-odometry": ros1_odometry, "ros2-tf": ros2_tf, "livox": livox, "doals": doals}

if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[2] not in RECIPES:
        sys.exit(__doc__ + "\nRecipes: " + ", ".join(RECIPES))
    target = pathlib.Path(sys.argv[3])
    target.mkdir(parents=True, exist_ok=True)
    RECIPES[sys.argv[2]](Drive(sys.argv[1]), target)
