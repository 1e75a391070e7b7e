# SPDX-License-Identifier: MIT
"""The occupancy map and its first-hit image, against walls whose distances are known."""
import unittest

import numpy as np

import raymoval
from support import raised, turned


def wall(x, half=8.0, step=0.25):
    """Points of a wall at right angles to x; x is the middle of a voxel."""
    y, z = np.meshgrid(np.arange(-half, half, step) + step / 2, np.arange(-half, half, step) + step / 2)
    return np.column_stack([np.full(y.size, x), y.ravel(), z.ravel()])


BINS = raymoval.Bins(azimuth=360, elevation=40, elevation_min=-0.35, elevation_max=0.35)


def expected_image(near):
    """Ranges to the plane x = near for each bin; infinite behind the sensor and beyond the wall."""
    rows, columns = np.mgrid[0:BINS.elevation, 0:BINS.azimuth]
    directions = np.stack([[BINS.direction(r, c) for c in range(BINS.azimuth)]
                           for r in range(BINS.elevation)])
    with np.errstate(divide="ignore"):
        ranges = np.where(directions[..., 0] > 0, near / directions[..., 0], np.inf)
    with np.errstate(invalid="ignore"):
        there = ranges[..., None] * directions
    ranges[~(np.abs(there[..., 1:]) < 8.0).all(axis=-1)] = np.inf
    return ranges


class Maps(unittest.TestCase):
    def test_voxels(self):
        own = raymoval.OccupancyMap(0.5)
        points = np.array([[0.1, 0.1, 0.1], [0.4, 0.4, 0.4], [-0.1, 0.6, 5.0]])
        self.assertEqual(own.insert(points), 2)  # The first two share a voxel.
        self.assertEqual(len(own), 2)
        self.assertEqual(sorted(own.voxels().tolist()), [[-1, 1, 10], [0, 0, 0]])
        self.assertEqual(own.contains(points + [0, 0, 0.5]).tolist(), [False, False, False])
        self.assertEqual(own.contains(points).tolist(), [True] * 3)
        self.assertEqual(own.erase(points[:2]), 1)
        self.assertEqual(len(own), 1)
        self.assertEqual(own.insert(points.astype(np.float32)[::-1]), 1)
        self.assertGreater(own.memory_bytes, 0)

    def test_mistakes(self):
        own = raymoval.OccupancyMap(0.5)
        raised(self, raymoval.UsageError, "(2, 2)", own.insert, np.zeros((2, 2)))
        raised(self, raymoval.UsageError, "bool", own.insert, np.zeros((2, 3), bool))
        raised(self, raymoval.DataError, "", own.insert, np.array([[np.nan, 0.0, 0.0]]))
        raised(self, raymoval.DataError, "", own.insert, np.array([[1e9, 0.0, 0.0]]))
        raised(self, raymoval.UsageError, "voxel_size", raymoval.OccupancyMap, 0.0)
        raised(self, raymoval.UsageError, "bins", raymoval.Bins, 2, 10)
        self.assertRaises(TypeError, raymoval.FirstHitCaster, None)
        raised(self, raymoval.UsageError, "ranges", raymoval.FirstHitCaster, own, 5.0, 3.0)
        raised(self, raymoval.UsageError, "(3, 4)", raymoval.FirstHitCaster(own).cast,
               np.zeros((3, 4)), BINS)


class Images(unittest.TestCase):
    def test_a_wall(self):
        own = raymoval.OccupancyMap(0.25)
        own.insert(wall(5.125))  # Its voxels begin at x = 5.
        image = raymoval.FirstHitCaster(own).cast(np.eye(4), BINS)
        self.assertEqual((image.shape, image.dtype), ((40, 360), np.float32))
        np.testing.assert_allclose(image, expected_image(5.0), rtol=1e-5)

    def test_it_turns_and_moves_with_the_sensor(self):
        own = raymoval.OccupancyMap(0.25)
        own.insert(wall(5.125))
        moved = turned(np.pi / 2, [1.0, 0.0, 0.0])  # It looks along y, and the wall is to its right.
        image = raymoval.FirstHitCaster(own).cast(moved, BINS)
        expected = np.roll(expected_image(4.0), -90, axis=1)
        same = np.isclose(image, expected, rtol=1e-4) | (np.isinf(image) & np.isinf(expected))
        self.assertGreater(same.mean(), 0.995)  # Rays along edges may go either way.

    def test_the_map_may_change_and_so_may_the_bins(self):
        own = raymoval.OccupancyMap(0.25)
        caster = raymoval.FirstHitCaster(own, maximum_range=7.0)
        self.assertTrue(np.isinf(caster.cast(np.eye(4), BINS)).all())
        own.insert(wall(10.125))
        self.assertTrue(np.isinf(caster.cast(np.eye(4), BINS)).all())  # Out of range.
        own.insert(wall(5.125))
        self.assertAlmostEqual(float(np.min(caster.cast(np.eye(4), BINS))), 5.0, delta=0.01)
        own.erase(wall(5.125))
        self.assertTrue(np.isinf(caster.cast(np.eye(4), BINS)).all())
        coarse = raymoval.Bins(90, 10, -0.35, 0.35)
        self.assertEqual(caster.cast(np.eye(4), coarse).shape, (10, 90))


if __name__ == "__main__":
    unittest.main()
