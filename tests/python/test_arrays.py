# SPDX-License-Identifier: MIT
"""Arrays of every legal form give the same masks; those of other forms are refused with a remedy."""
import unittest

import numpy as np

import raymoval
from support import QUIET, KeepAll, NearPoints, raised, street, turned


def masks_of(scans, poses, **named):
    made = raymoval.clean(scans, poses, "raymoval:online", sensor="vlp16", up="z", **QUIET, **named)
    return [mask.tolist() for mask in made]


class FormsOfArrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sequence, cls.scans, cls.poses = street()
        cls.expected = masks_of(cls.scans, cls.poses)

    def test_something_is_removed(self):
        self.assertGreater(sum(map(sum, self.expected)), 0)

    def test_float64(self):
        self.assertEqual(masks_of([s.astype(np.float64) for s in self.scans], self.poses),
                         self.expected)

    def test_strides(self):
        def strided(scan):
            wide = np.full((2 * len(scan), 7), np.nan, np.float32)
            wide[::2, 5:2:-1] = scan
            return wide[::2, 5:2:-1]

        views = [strided(scan) for scan in self.scans]
        self.assertFalse(views[0].flags.c_contiguous)
        self.assertEqual(masks_of(views, self.poses), self.expected)

    def test_columns_first(self):
        self.assertEqual(masks_of([np.asfortranarray(s) for s in self.scans], self.poses),
                         self.expected)

    def test_unaligned(self):
        def unaligned(scan):
            raw = np.zeros(scan.nbytes + 1, np.uint8)
            view = np.frombuffer(raw.data, np.float32, scan.size, offset=1).reshape(-1, 3)
            view[:] = scan
            return view

        self.assertEqual(masks_of([unaligned(s) for s in self.scans], self.poses), self.expected)

    def test_reflectance_beside_the_points(self):
        wide = [np.column_stack([s, np.ones(len(s), np.float32)]) for s in self.scans]
        self.assertEqual(masks_of(wide, self.poses), self.expected)

    def test_read_only(self):
        for scan in self.scans:
            scan.flags.writeable = False
        self.assertEqual(masks_of(self.scans, self.poses), self.expected)

    def test_generator(self):
        self.assertEqual(masks_of((s for s in self.scans), self.poses), self.expected)

    def test_sequence_that_makes_its_scans_when_asked(self):
        asked = []

        class Lazy:
            def __len__(lazy):
                return len(self.scans)

            def __getitem__(lazy, index):
                asked.append(index)
                return self.scans[index]

        self.assertEqual(masks_of(Lazy(), self.poses), self.expected)
        self.assertEqual(set(asked), set(range(len(self.scans))))

    def test_any_number_of_threads(self):
        for threads in (1, 2, 8):
            self.assertEqual(masks_of(self.scans, self.poses, threads=threads), self.expected)

    def test_poses_in_another_world(self):
        shift = turned(0.0, [500000.0, 5400000.0, 300.0])
        self.assertEqual(masks_of(self.scans, shift @ self.poses), self.expected)

    def test_no_copy_of_a_scan(self):
        points = self.sequence[0].points
        self.assertIsInstance(points.base, raymoval.Scan)
        self.assertEqual((points.dtype, points.strides), (np.float32, (12, 4)))


class Rows(unittest.TestCase):
    """A mask has a value for each row of its array."""

    def test_rows_without_a_return_are_kept_and_not_seen(self):
        points = np.array([[5, 0, 0], [np.nan, 0, 0], [50, 0, 0], [0, 0, 0], [6, 0, 0]], np.float32)
        seen = []

        class Counts(NearPoints):
            def run(self, scans, sink):
                seen.extend(len(scan) for scan in scans)
                super().run(scans, sink)

        masks = raymoval.clean([points], [np.eye(4)], Counts(), sensor="vlp16", up="z", **QUIET)
        self.assertEqual(seen, [3])
        self.assertEqual(masks[0].tolist(), [True, False, False, False, True])
        self.assertEqual(masks[-1].dtype, np.bool_)
        self.assertEqual(masks.removed_count, 2)
        self.assertRaises(IndexError, lambda: masks[1])

    def test_labels_have_a_word_for_each_row(self):
        points = np.array([[5, 0, 0], [np.nan, 0, 0], [50, 0, 0]], np.float32)
        sequence = raymoval.from_arrays([points], [np.eye(4)], labels=[[252, 252, 40]])
        self.assertEqual(sequence[0].labels.tolist(), [252, 40])
        self.assertEqual(sequence[0].moving.tolist(), [True, False])
        self.assertEqual(sequence[0].stored_index.tolist(), [0, 2])
        self.assertEqual(sequence[0].stored_point_count, 3)
        short = raymoval.from_arrays([points], [np.eye(4)], labels=[[252, 40]])
        raised(self, raymoval.DataError, "there are 2, expected one for each of its 3 points",
               lambda: short[0].labels)


class Mistakes(unittest.TestCase):
    """Each says what, where, what was expected, and mostly what to do."""

    def setUp(self):
        self.scans = [np.full((4, 3), i + 5.0, np.float32) for i in range(3)]
        self.poses = np.stack([np.eye(4)] * 3)

    def clean(self, scans=None, poses=None, method=KeepAll, **named):
        return raymoval.clean(self.scans if scans is None else scans,
                              self.poses if poses is None else poses, method, **QUIET, **named)

    def refused(self, kind, text, **named):
        return raised(self, kind, text, self.clean, **named)

    def test_shape(self):
        self.refused(raymoval.UsageError, "scan 1: the points have the shape (4, 2)",
                     scans=[self.scans[0], np.zeros((4, 2), np.float32), self.scans[2]])
        self.refused(raymoval.UsageError, "Transpose them",
                     scans=[np.zeros((3, 1), np.float32)] * 3)
        self.refused(raymoval.UsageError, "expected a list", scans=self.scans[0])
        self.refused(raymoval.UsageError, "raymoval.open first", scans="street")

    def test_type_of_numbers(self):
        self.refused(raymoval.UsageError, "scan 0: the points are int32, expected float32 or float64",
                     scans=[scan.astype(np.int32) for scan in self.scans])
        self.refused(raymoval.UsageError, "are >f4",
                     scans=[scan.astype(">f4") for scan in self.scans])
        self.refused(ValueError, "is a tuple", scans=[(scan, 0.0) for scan in self.scans])

    def test_poses(self):
        self.refused(raymoval.UsageError, "Append the row 0 0 0 1", poses=self.poses[:, :3])
        self.refused(raymoval.UsageError, "3 scans and 2 poses", poses=self.poses[:2])
        self.refused(raymoval.UsageError, "more scans than the 2 poses",
                     scans=iter(self.scans), poses=self.poses[:2])
        self.refused(raymoval.UsageError, "2 scans and 3 poses", scans=iter(self.scans[:2]))
        self.refused(raymoval.DataError, "pose 1", poses=self.poses * [[[1]], [[2]], [[1]]])
        self.refused(raymoval.DataError, "Transpose it", poses=np.stack(
            [turned(0.0, [1, 2, 3]).T] * 3))
        bad = self.poses.copy()
        bad[2, 0, 0] = np.nan
        self.refused(raymoval.DataError, "pose 2", poses=bad)
        raised(self, raymoval.UsageError, "poses are missing", raymoval.clean, self.scans, **QUIET)

    def test_nan(self):
        # A scan without returns is a scan.
        scans = [self.scans[0], np.full((4, 3), np.nan, np.float32), self.scans[2]]
        self.assertEqual([len(mask) for mask in self.clean(scans)], [4, 4, 4])
        infinite = [np.full((4, 3), np.inf, np.float32)] * 3
        self.refused(raymoval.DataError, "4 of 4 points are infinite", scans=infinite)

    def test_names(self):
        self.refused(raymoval.UsageError, "Did you mean 'erasor'?", method="erasr")
        self.refused(raymoval.ConfigurationError, "tau0", method="raymoval", tau=0.3)
        self.refused(raymoval.ConfigurationError, "vlp16", sensor="vlp61")
        self.refused(raymoval.UsageError, "as attributes", distance=3.0)
        self.refused(raymoval.UsageError, "is not a direction", up="above")

    def test_an_opened_sequence_has_its_own_poses(self):
        raised(self, raymoval.UsageError, "of its own", raymoval.clean, street(4)[0], self.poses)

    def test_scans_that_raise(self):
        class Broken:
            def __len__(self):
                return 3

            def __getitem__(self, index):
                raise LookupError(f"scan {index} is on the other disk")

        self.refused(LookupError, "is on the other disk", scans=Broken())

        def broken():
            yield self.scans[0]
            raise OSError("unplugged")

        self.refused(OSError, "unplugged", scans=broken())


if __name__ == "__main__":
    unittest.main()
