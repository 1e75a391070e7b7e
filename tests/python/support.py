# SPDX-License-Identifier: MIT
"""Scenes for the tests of the Python package, small enough to be worked out by hand."""
import unittest

import numpy as np

import raymoval

QUIET = {"progress": False}


def raised(case: unittest.TestCase, kind, text, function, *arguments, **named):
    """Checks that a call raises `kind` with `text` in its message; returns the message."""
    with case.assertRaises(kind) as caught:
        function(*arguments, **named)
    message = str(caught.exception)
    case.assertIn(text, message)
    return message


def street(scans=12):
    """The first scans of the scene `street`: opened, and as arrays with poses."""
    sequence = raymoval.open("street", frames=f"0:{scans - 1}", **QUIET)
    return sequence, [scan.points.copy() for scan in sequence], sequence.poses


def turned(angle, position):
    """A pose that is turned by `angle` about z."""
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    pose[:3, 3] = position
    return pose


class KeepAll(raymoval.Remover):
    """Removes nothing."""

    def run(self, scans, sink):
        for scan in scans:
            sink.accept(scan.index, np.zeros(len(scan), bool))


class NearPoints(raymoval.Remover):
    """Removes what is near."""

    distance = 10.0

    def run(self, scans, sink):
        for scan in scans:
            sink.accept(scan.index, np.linalg.norm(scan.points, axis=1) < self.distance)
