# SPDX-License-Identifier: MIT
"""The drive of these comparisons: a motion in closed form, and small scans along it."""
import numpy as np

START_NS = 1_700_000_000_000_000_000
PERIOD_NS = 100_000_000
SCANS = 4
STAMPS = [START_NS + i * PERIOD_NS + 123 for i in range(SCANS)]


def turn(axis, angle):
    """A 4 x 4 matrix that turns about an axis (0, 1 or 2)."""
    result = np.eye(4)
    i, k = [(1, 2), (2, 0), (0, 1)][axis]
    result[i, i] = result[k, k] = np.cos(angle)
    result[k, i], result[i, k] = np.sin(angle), -np.sin(angle)
    return result


def moved(x, y, z):
    result = np.eye(4)
    result[:3, 3] = x, y, z
    return result


# Where the sensor is on its body.
MOUNT = moved(0.5, -0.2, 1.1) @ turn(2, 0.4) @ turn(0, 0.05)


def body(stamp):
    """A straight way at 3 m/s with a steady turn, between whose poses a line and slerp are exact."""
    time = (stamp - START_NS) * 1e-9
    return moved(3 * time, 1.5 * time - 2, 0.2) @ turn(2, 0.7 * time + 0.3) @ turn(1, 0.1)


def quaternion(pose):
    """x y z w, with w > 0."""
    w = np.sqrt(1 + np.trace(pose[:3, :3])) / 2
    return np.array([pose[2, 1] - pose[1, 2], pose[0, 2] - pose[2, 0], pose[1, 0] - pose[0, 1],
                     4 * w * w]) / (4 * w)


def from_quaternion(position, xyzw):
    x, y, z, w = np.array(xyzw) / np.linalg.norm(xyzw)
    result = moved(*position)
    result[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return result


def from_euler(position, roll, pitch, yaw):
    return moved(*position) @ turn(2, yaw) @ turn(1, pitch) @ turn(0, roll)


def from_vector(position, vector):
    angle = np.linalg.norm(vector)
    x, y, z = np.array(vector) / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result = moved(*position)
    result[:3, :3] = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return result


def near(answer, expected):
    """Whether the poses of a sequence that raymoval opened are these, within 1e-9."""
    if answer is None or len(answer["scans"]) != len(expected):
        return False
    return all(np.abs(np.array(scan["pose"]).reshape(3, 4) - pose[:3]).max() < 1e-9
               for scan, pose in zip(answer["scans"], expected))
