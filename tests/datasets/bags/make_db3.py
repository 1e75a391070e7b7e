#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the databases of tests/fuzz/corpus/bag_db3/ by Python's sqlite3, with the tables of rosbag2,
and the program zstd.

    python3 tests/datasets/bags/make_db3.py tests/fuzz/corpus/bag_db3
"""

import os
import sqlite3
import subprocess
import sys

TABLES = """
CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
MESSAGES = [(1, 1000, "points 0"), (2, 1500, "pose 0"), (1, 3000, "points 2"), (1, 2000, "points 1"),
            (2, 1500, "pose 1")]


def packed(data):
    return subprocess.run(["zstd", "-c"], input=data, stdout=subprocess.PIPE, check=True).stdout


def write(path, page_size, more="", pack=bytes):
    """Writes one database, with `more` put behind each message. @param pack makes its bytes"""
    if os.path.exists(path):
        os.remove(path)
    database = sqlite3.connect(path)
    database.execute(f"PRAGMA page_size={page_size}")
    database.executescript(TABLES)
    database.executemany("INSERT INTO topics VALUES(?,?,?,'cdr','')",
                         [(1, "/points", "sensor_msgs/msg/PointCloud2"),
                          (2, "/pose", "geometry_msgs/msg/PoseStamped")])
    database.executemany("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)",
                         [(topic, time, pack(b"\0\1\0\0" + text.encode() + more.encode()))
                          for topic, time, text in MESSAGES])
    database.commit()
    database.close()


write(sys.argv[1] + "/small.db3", 512)
write(sys.argv[1] + "/overflow.db3", 512, "." * 600)
write(sys.argv[1] + "/packed.db3", 512, pack=packed)  # As rosbag2 does with --compression-mode message.
