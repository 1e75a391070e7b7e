# SPDX-License-Identifier: MIT
"""Poses from scans: estimated, refined, and written."""
import os
import tempfile
import unittest

import numpy as np

import raymoval
from support import QUIET, raised, street


def from_first(poses):
    return np.linalg.inv(poses[0]) @ poses


class Poses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sequence, cls.scans, cls.poses = street()
        cls.wrong = cls.poses.copy()
        cls.wrong[6:, 1, 3] += 0.5

    def test_refined_poses_of_a_jump(self):
        refined = raymoval.refine(self.scans, self.wrong, **QUIET)
        off = from_first(refined)[:, :3, 3] - from_first(self.poses)[:, :3, 3]
        self.assertLess(np.abs(off[:, 1]).max(), 0.1)

    def test_a_sequence_and_its_arrays_give_the_same_poses(self):
        of_arrays = raymoval.refine(self.scans, self.wrong, threads=1, **QUIET)
        sequence = raymoval.from_arrays(self.scans, self.wrong)
        np.testing.assert_array_equal(of_arrays, raymoval.refine(sequence, threads=2, **QUIET))

    def test_the_street_is_a_corridor(self):
        raised(self, raymoval.DataError, "are uncertain", raymoval.estimate, self.sequence, **QUIET)

    def test_right_poses_are_kept(self):
        with self.assertWarnsRegex(UserWarning, "The given poses are kept"):
            poses = raymoval.refine(self.scans, self.poses, **QUIET)
        np.testing.assert_array_equal(poses, self.poses)

    def test_the_file_holds_the_poses(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "rows_kitti.txt")
            poses = raymoval.refine(self.scans, self.wrong, file=path, **QUIET)
            np.testing.assert_allclose(np.loadtxt(path), poses[:, :3].reshape(-1, 12), atol=1e-9)

    def test_a_sensor_at_rest(self):
        with self.assertWarnsRegex(UserWarning, "at rest"):
            poses = raymoval.estimate([self.scans[3]] * 4, **QUIET)
        np.testing.assert_allclose(poses, np.tile(np.eye(4), (4, 1, 1)), atol=0.01)

    def test_what_does_not_work(self):
        raised(self, raymoval.DataError, "does not overlap enough", raymoval.estimate,
               [self.scans[0], self.scans[0] + np.float32(500.0)], **QUIET)
        raised(self, raymoval.UsageError, "poses and times of its own", raymoval.refine,
               self.sequence, self.poses, **QUIET)


if __name__ == "__main__":
    unittest.main()
