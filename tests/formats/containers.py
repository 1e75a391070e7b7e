# SPDX-License-Identifier: MIT
"""Recordings written and read by others: ROS's rosbag, npm's @mcap/core, Python's sqlite3.

A recording is a list of messages (topic, type as in ROS 1, stamp, bytes) in the order of the file.
"""
import json
import os
import sqlite3
import subprocess
import sys

SCRIPT = os.path.join(os.path.dirname(__file__), "mcap.mjs")


def ros2_type(kind):
    return kind.replace("/", "/msg/")


# --- ROS 1 ---
class Definition:
    """What rosbag asks of the class of a message, for one that Debian has not."""
    _full_text, _md5sum = "", "*"


def write_ros1(path, messages, closed=True, **options):
    """By rosbag. @param closed else the file is as it is while the recording goes on"""
    import rosbag  # pylint: disable=import-outside-toplevel
    import roslib.message  # pylint: disable=import-outside-toplevel
    import rospy  # pylint: disable=import-outside-toplevel
    with rosbag.Bag(path + (".active" if not closed else ""), "w", **options) as bag:
        for topic, kind, stamp, data in messages:
            known = roslib.message.get_message_class(kind) or Definition
            bag.write(topic, (kind, data, known._md5sum, known),
                      rospy.Time(stamp // 10**9, stamp % 10**9), raw=True)
        if not closed:
            bag.flush()
            with open(path + ".active", "rb") as under_way, open(path, "wb") as copy:
                copy.write(under_way.read())


# --- MCAP ---
def mcap_file(path, messages, packing="", profile="ros2", **options):
    named = ros2_type if profile == "ros2" else str
    return {"file": path, "profile": profile, "packing": packing, "options": options,
            "messages": [{"topic": topic, "type": named(kind), "time": str(stamp), "hex": data.hex()}
                         for topic, kind, stamp, data in messages]}


def write_mcap(*files):
    done = subprocess.run(["node", SCRIPT, "write"], input=json.dumps(files), text=True,
                          capture_output=True, check=False)
    if done.returncode != 0:
        print(done.stderr, file=sys.stderr)
    return done.returncode == 0


# --- ROS 2's databases and folders ---
def zstd(data):
    return subprocess.run(["zstd", "-c"], input=data, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, check=True).stdout


def write_db3(path, messages, packed=False):
    """@param packed each message by zstd"""
    if os.path.exists(path):
        os.remove(path)
    database = sqlite3.connect(path)
    database.executescript(
        "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
        "INSERT INTO schema VALUES(4, 'rolling');"
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
        " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,"
        " type_description_hash TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
        " timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);")
    topics = list(dict.fromkeys(message[:2] for message in messages))
    for number, (topic, kind) in enumerate(topics, 1):
        database.execute("INSERT INTO topics VALUES(?,?,?,'cdr','','')",
                         (number, topic, ros2_type(kind)))
    for topic, kind, stamp, data in messages:
        database.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)",
                         (topics.index((topic, kind)) + 1, stamp, zstd(data) if packed else data))
    database.commit()
    database.close()


def write_metadata(folder, storage, files, mode="", version=5):
    """@param files of (name, messages)"""
    everything = [message for _, messages in files for message in messages]
    stamps = [message[2] for message in everything]
    lines = [f"version: {version}", f"storage_identifier: {storage}",
             "duration:", f"  nanoseconds: {max(stamps) - min(stamps)}", "starting_time:",
             f"  nanoseconds_since_epoch: {min(stamps)}", f"message_count: {len(everything)}",
             "topics_with_message_count:"]
    for topic, kind in dict.fromkeys(message[:2] for message in everything):
        count = sum(message[0] == topic for message in everything)
        lines += ["  - topic_metadata:", f"      name: {topic}", f"      type: {ros2_type(kind)}",
                  "      serialization_format: cdr",
                  "      offered_qos_profiles: \"- history: 1\\n  depth: 10\"",
                  f"    message_count: {count}"]
    lines += [f"compression_format: \"{'zstd' if mode else ''}\"", f"compression_mode: \"{mode}\"",
              "relative_file_paths:"]
    lines += [f"  - {os.path.basename(folder) + '/' if version <= 3 else ''}{name}"
              for name, _ in files]
    if version >= 5:
        lines.append("files:")
        for name, messages in files:
            lines += [f"  - path: {name}", "    starting_time:",
                      f"      nanoseconds_since_epoch: {messages[0][2]}", "    duration:",
                      f"      nanoseconds: {messages[-1][2] - messages[0][2]}",
                      f"    message_count: {len(messages)}"]
    with open(f"{folder}/metadata.yaml", "w", encoding="utf-8") as file:
        file.write("rosbag2_bagfile_information:\n" + "".join(f"  {line}\n" for line in lines))
