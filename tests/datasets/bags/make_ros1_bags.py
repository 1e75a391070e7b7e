#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the ROS 1 bags in tests/fuzz/corpus/bag_ros1 with ROS's own rosbag (Debian: python3-rosbag
python3-sensor-msgs python3-nav-msgs), so that the reader is tested on files that others wrote.

  tests/datasets/bags/make_ros1_bags.py FOLDER

Each has three clouds of two points on /points, 0.1 s apart, an odometry before and behind them on
/odom, which moves 1 m along x in a second, and chunks of a cloud or two.
"""
import struct
import sys

import rosbag
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField


def cloud(number):
    message = PointCloud2()
    message.header.seq = number
    message.header.stamp = rospy.Time(1000, 100000000 * number + 1)
    message.header.frame_id = "lidar"
    message.height, message.width = 1, 2
    message.fields = [PointField(name, 4 * i, 7, 1) for i, name in enumerate("xyz")]
    message.fields.append(PointField("ring", 12, 4, 1))
    message.point_step, message.row_step = 16, 32
    message.data = struct.pack("<3fH2x3fH2x", 1 + number, 2, 3, 7, 4, 5, 6, 8)
    return message


def odometry(seconds):
    message = Odometry()
    message.header.stamp = rospy.Time(seconds)
    message.header.frame_id, message.child_frame_id = "odom", "lidar"
    message.pose.pose.position.x = seconds - 1000
    message.pose.pose.orientation.w = 1
    return message


def write(bag, topic, message, time):
    # The definitions of types would be most of the file.
    header = {"topic": topic, "type": message._type, "md5sum": message._md5sum,
              "message_definition": "short"}
    bag.write(topic, message, time, connection_header=header)


for name, options in {"rosbag_none": {}, "rosbag_bz2": {"compression": "bz2"},
                      "rosbag_lz4": {"compression": "lz4"}}.items():
    with rosbag.Bag(f"{sys.argv[1]}/{name}.bag", "w", chunk_threshold=500, **options) as bag:
        write(bag, "/odom", odometry(1000), rospy.Time(1000))
        for number in range(3):
            write(bag, "/points", cloud(number), rospy.Time(1000, 100000000 * (number + 1)))
        write(bag, "/odom", odometry(1001), rospy.Time(1001))
