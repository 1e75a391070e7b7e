# SPDX-License-Identifier: MIT
"""Messages as bytes: of ROS 1 by Debian's genpy classes, in CDR by npm's @foxglove packages, and
both by plain Python, which also knows what the others do not: Livox, and big-endian CDR."""
import json
import os
import struct
import subprocess
import sys

import numpy as np

from motion import quaternion

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "cli"))
from recipe_data import Message  # pylint: disable=wrong-import-position

NUMBERS = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}


class BigEndian(Message):
    """CDR with the other byte order."""

    def __init__(self):
        super().__init__(ros1=False)

    def put(self, code, *values):
        for value in values:
            self.body += bytes(-len(self.body) % struct.calcsize("<" + code))
            self.body += struct.pack(">" + code, value)

    def done(self):
        return b"\0\0\0\0" + bytes(self.body)


def begun(form):
    return BigEndian() if form == "CDR big-endian" else Message(form == "ROS 1")


class Cloud:
    """A PointCloud2: an array of points and how it is laid out."""

    def __init__(self, array, height=1, row_padding=0, big_endian=False, row_step=None):
        self.array = array
        self.height, self.width = height, len(array) // height
        self.big_endian = big_endian
        stored = array.astype(array.dtype.newbyteorder(">")) if big_endian else array
        rows = [stored[i * self.width:(i + 1) * self.width].tobytes() + b"\xAA" * row_padding
                for i in range(height)]
        self.data = b"".join(rows)
        self.row_step = len(rows[0]) if row_step is None else row_step

    def fields(self):
        dtype = self.array.dtype
        return [(name, dtype.fields[name][1], NUMBERS[dtype[name].base.str[1:]],
                 int(np.prod(dtype[name].shape, dtype=int))) for name in dtype.names]

    def bytes(self, form, stamp, frame="lidar"):
        message = begun(form)
        message.header(stamp, frame)
        message.put("I", self.height, self.width, len(self.fields()))
        for name, offset, kind, count in self.fields():
            message.text(name)
            message.put("I", offset)
            message.put("B", kind)
            message.put("I", count)
        message.put("B", self.big_endian)
        message.put("I", self.array.itemsize, self.row_step, len(self.data))
        message.body += self.data
        message.put("B", 1)
        return message.done()

    def value(self, stamp, frame="lidar"):
        """For npm's packages."""
        return {"header": header(stamp, frame), "height": self.height, "width": self.width,
                "fields": [dict(zip(("name", "offset", "datatype", "count"), field))
                           for field in self.fields()],
                "is_bigendian": self.big_endian, "point_step": self.array.itemsize,
                "row_step": self.row_step, "data": self.data.hex(), "is_dense": True}

    def genpy(self, stamp, frame="lidar"):
        """For Debian's classes."""
        from sensor_msgs.msg import PointCloud2, PointField  # pylint: disable=import-outside-toplevel
        message = PointCloud2()
        stamped(message, stamp, frame)
        message.height, message.width = self.height, self.width
        message.fields = [PointField(*field) for field in self.fields()]
        message.is_bigendian, message.is_dense = self.big_endian, True
        message.point_step, message.row_step = self.array.itemsize, self.row_step
        message.data = self.data
        return message


def livox(form, stamp, rows):
    """@param rows of offset_time x y z reflectivity tag line"""
    message = begun(form)
    message.header(stamp, "lidar")
    message.put("Q", stamp)
    message.put("I", len(rows))
    message.put("B", 0, 0, 0, 0)
    message.put("I", len(rows))
    for row in rows:
        for code, value in zip("IfffBBB", row):
            message.put(code, value)
    return message.done()


def header(stamp, frame):
    return {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9, "nsec": stamp % 10**9},
            "frame_id": frame}


def stamped(message, stamp, frame):
    import rospy  # pylint: disable=import-outside-toplevel
    message.header.stamp = rospy.Time(stamp // 10**9, stamp % 10**9)
    message.header.frame_id = frame


# --- poses ---
HEADER = """
================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
POSE = """
================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
""" + HEADER
COVERED = """
================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
""" + POSE
TRANSFORM = """
================
MSG: geometry_msgs/Transform
geometry_msgs/Point translation
geometry_msgs/Quaternion rotation
""" + POSE
STAMPED_TRANSFORM = "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"
DEFINITIONS = {
    "sensor_msgs/PointCloud2": """std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================
MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count
""" + HEADER,
    "nav_msgs/Odometry": """std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
================
MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
================
MSG: geometry_msgs/Twist
geometry_msgs/Point linear
geometry_msgs/Point angular
""" + COVERED,
    "geometry_msgs/PoseStamped": "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + POSE,
    "geometry_msgs/PoseWithCovarianceStamped":
        "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n" + COVERED,
    "geometry_msgs/TransformStamped": STAMPED_TRANSFORM + TRANSFORM,
    "nav_msgs/Path": "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"
                     "================\nMSG: geometry_msgs/PoseStamped\n"
                     "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + POSE,
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms\n================\n"
                          "MSG: geometry_msgs/TransformStamped\n" + STAMPED_TRANSFORM + TRANSFORM,
}


def vector(values):
    return dict(zip("xyzw", map(float, values)))


def pose_value(kind, poses, frame, child):
    """The value of a message. @param poses of (stamp, matrix); only a path has several"""
    def transform(stamp, pose):
        return {"header": header(stamp, frame), "child_frame_id": child,
                "transform": {"translation": vector(pose[:3, 3]), "rotation": vector(quaternion(pose))}}

    def plain(stamp, pose):
        return {"header": header(stamp, frame), "pose": {
            "position": vector(pose[:3, 3]), "orientation": vector(quaternion(pose))}}

    stamp, pose = poses[0]
    zero = {"linear": vector([0, 0, 0]), "angular": vector([0, 0, 0])}
    if kind == "tf2_msgs/TFMessage":
        return {"transforms": [transform(*one) for one in poses]}
    if kind == "nav_msgs/Path":
        return {"header": header(stamp, frame), "poses": [plain(*one) for one in poses]}
    if kind == "geometry_msgs/TransformStamped":
        return transform(stamp, pose)
    value = plain(stamp, pose)
    if kind in ("nav_msgs/Odometry", "geometry_msgs/PoseWithCovarianceStamped"):
        value["pose"] = {"pose": value["pose"], "covariance": [0.0] * 36}
    if kind == "nav_msgs/Odometry":
        value.update(child_frame_id=child, twist={"twist": zero, "covariance": [0.0] * 36})
    return value


def genpy_message(kind, value):
    """A message of Debian's classes with this value."""
    import genpy  # pylint: disable=import-outside-toplevel
    import roslib.message  # pylint: disable=import-outside-toplevel
    message = roslib.message.get_message_class(kind)()
    names = {"nanosec": None, "sec": "secs", "nsec": "nsecs"}

    def renamed(item):
        if isinstance(item, list):
            return [renamed(one) for one in item]
        if not isinstance(item, dict):
            return item
        return {names.get(key, key): renamed(one) for key, one in item.items()
                if names.get(key, key) is not None}

    genpy.message.fill_message_args(message, [renamed(value)])
    return message


def cdr_messages(kinds_and_values):
    """By npm's @foxglove/rosmsg2-serialization. @return the bytes, or None without it"""
    script = os.path.join(os.path.dirname(__file__), "mcap.mjs")
    wanted = [{"definition": DEFINITIONS[kind], "value": value} for kind, value in kinds_and_values]
    done = subprocess.run(["node", script, "cdr"], input=json.dumps(wanted), text=True,
                          capture_output=True, check=False)
    if done.returncode != 0:
        print(done.stderr, file=sys.stderr)
        return None
    return [bytes.fromhex(text) for text in json.loads(done.stdout)]
