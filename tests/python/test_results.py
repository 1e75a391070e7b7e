# SPDX-License-Identifier: MIT
"""Scores and runs: the same as those of the program, of which some are known by hand."""
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import raymoval
from support import QUIET, KeepAll, NearPoints, raised, street

PROGRAM = os.environ["RAYMOVAL_PROGRAM"]


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], check=True,
                          capture_output=True, text=True).stdout


class ScoresOfMasks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sequence, cls.scans, cls.poses = street(8)
        cls.moving = [scan.moving for scan in cls.sequence]

    def score(self, masks, protocols="erasor", **named):
        return raymoval.score(self.sequence, masks, protocols, **QUIET, **named)

    def test_known_answers(self):
        kept = self.score([np.zeros(len(m), bool) for m in self.moving])["erasor"]
        self.assertEqual((kept["PR"], kept["RR"]), (100.0, 0.0))
        gone = self.score([np.ones(len(m), bool) for m in self.moving])["erasor"]
        self.assertEqual((gone["PR"], gone["RR"]), (0.0, 100.0))
        exact = self.score(self.moving, ["erasor", "dynamicmap", "mos"])
        self.assertEqual(exact["erasor"]["RR"], 100.0)
        self.assertEqual((exact["dynamicmap"]["SA"], exact["dynamicmap"]["DA"]), (100.0, 100.0))
        points = sum(map(sum, self.moving))
        self.assertEqual(exact.columns["recall"], (100.0, points, points))

    def test_counts_rates_and_intervals_are_the_programs(self):
        masks = raymoval.clean(self.sequence, method="raymoval:online", **QUIET)
        ours = self.score(masks, ["erasor", "dynamicmap"])
        with tempfile.TemporaryDirectory() as folder:
            program("clean", "street", "--frames", "0:7", "--method", "raymoval:online", "--labels",
                    f"{folder}/labels", "--in-process")
            program("score", "street", "--frames", "0:7", "--predictions", f"{folder}/labels",
                    "--protocol", "erasor", "--protocol", "dynamicmap", "--json",
                    f"{folder}/score.json")
            theirs = json.loads(Path(f"{folder}/score.json").read_text())["protocols"]
            words = [np.fromfile(f"{folder}/labels/{i:06d}.label", np.uint32) for i in range(8)]
        self.assertEqual([mask.tolist() for mask in masks],
                         [(one == 251).tolist() for one in words])
        for one in theirs:
            own = ours[one["protocol"]]
            self.assertEqual(own.counts, one["counts"])
            for name, value in one["rates"].items():
                self.assertEqual(own[name], value)
        low, high = ours["erasor"].intervals["PR"]
        self.assertLessEqual(low, ours["erasor"]["PR"])
        self.assertGreaterEqual(high, ours["erasor"]["PR"])

    def test_arrays_with_labels_score_alike(self):
        masks = raymoval.clean(self.sequence, method="raymoval:online", **QUIET)
        expected = self.score(masks)["erasor"]
        # A row without a return before and behind every scan.
        gap = np.full((1, 3), np.nan, np.float32)
        arrays = raymoval.from_arrays(
            [np.concatenate([gap, scan, gap]) for scan in self.scans], self.poses,
            labels=[np.concatenate([[0], scan.labels, [0]]) for scan in self.sequence],
            sensor=self.sequence.sensor, up=self.sequence.up)
        same = raymoval.clean(arrays, method="raymoval:online", **QUIET)
        self.assertEqual(same[3].tolist(), [False, *masks[3].tolist(), False])
        for given in (same, list(same)):
            scored = raymoval.score(arrays, given, **QUIET)["erasor"]
            self.assertEqual(scored.counts, expected.counts)

    def test_what_cannot_be_scored(self):
        raised(self, raymoval.MethodError, "mask 2: has 3 values", self.score,
               [*self.moving[:2], np.zeros(3, bool), *self.moving[3:]])
        raised(self, raymoval.MethodError, "there are 7 masks", self.score, self.moving[:7])
        raised(self, raymoval.UsageError, "Did you mean 'erasor'?", self.score, self.moving, "erasr")
        bare = raymoval.from_arrays(self.scans, self.poses)
        raised(self, raymoval.DataError, "has no labels", raymoval.score, bare, self.moving, **QUIET)

    def test_options(self):
        coarse = self.score(self.moving, options={"erasor.voxel_size": 1.0})["erasor"]
        self.assertLess(coarse.counts["static_voxels"],
                        self.score(self.moving)["erasor"].counts["static_voxels"])


class Runs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.sequence = raymoval.open("street", frames="0:7", **QUIET)

    def run_into(self, name, methods, **named):
        return raymoval.run(self.sequence, methods, out=f"{self.folder}/{name}", **QUIET, **named)

    def test_a_run_is_the_programs(self):
        run = self.run_into("ours", ["raymoval:online"])
        self.assertTrue(run.good)
        self.assertEqual(run.cells, 4)
        program("run", "street", "--frames", "0:7", "--method", "raymoval:online", "--out",
                f"{self.folder}/theirs")
        same = raymoval.compare(run, f"{self.folder}/theirs")
        self.assertEqual((same.verdict, same.exit_code, same.same_cells), ("no regression", 0, 4))
        self.assertEqual(self.run_into("ours", ["raymoval:online"]).reused, 4)

    def test_methods_in_python_beside_others(self):
        class Fails(KeepAll):
            def run(self, scans, sink):
                super().run(scans, sink)
                raise ValueError("at the end")

        run = self.run_into("mixed", [KeepAll, NearPoints(), Fails], keep_removals=True)
        rows = {row["cell"]: row for row in run.rows}
        self.assertEqual(rows["keep_all:python"]["PR"], 100.0)
        self.assertEqual(rows["keep_all:python"]["RR"], 0.0)
        self.assertEqual(rows["near_points:python"]["status"], "ok")
        self.assertEqual(rows["fails:python"]["status"], "failed")
        self.assertEqual(len(run.failures), 1)
        self.assertIn("method 'fails' raised ValueError: at the end", run.failures[0])
        self.assertIn("test_results.py, line", run.failures[0])
        self.assertFalse(run.good)
        self.assertIn("near_points:python", str(run))

    def test_a_parameter_is_another_cell(self):
        self.run_into("near", [NearPoints])
        changed = NearPoints()
        changed.distance = 2.0
        self.assertEqual(self.run_into("near", [changed]).reused, 3)
        for reused in (3, 4):  # The first is beside the method without the setting.
            again = self.run_into("near", [NearPoints], settings={"near_points.distance": 2.0})
            self.assertEqual(again.reused, reused)
        self.assertIn("near_points:python*", [row["cell"] for row in again.rows])

    def test_a_run_without_a_folder_goes_with_its_object(self):
        run = raymoval.run(self.sequence, "noop", controls=False, **QUIET)
        folder = run.folder
        self.assertEqual(len(run.rows), 1)
        del run
        self.assertFalse(os.path.exists(folder))

    def test_a_run_warns_of_scans_without_a_pose(self):
        drive = Path(self.folder, "drive")
        program("simulate", "town", "-o", drive, "--scans", "5", "--sensor", "vlp16")
        times = (drive / "times.txt").read_text().split()
        poses = (drive / "poses.txt").read_text().splitlines()
        rows = [f"{time} {pose}\n" for time, pose in zip(times, poses)]
        (drive / "early.txt").write_text("".join(rows[:4]))
        early = raymoval.open(drive, poses="early.txt", **QUIET)
        lost = "early.txt: 1 of 5 scans have no pose: 1 after the last pose. They are left out."
        self.assertEqual(early.notes, [f"{drive}/{lost}"])
        run = raymoval.run(early, "noop", controls=False, **QUIET)
        self.assertEqual(run.warnings, [f"town: {drive}/{lost}"])
        whole = raymoval.run(drive, "noop", controls=False, **QUIET)
        self.assertEqual(whole.warnings, [])

    def test_compare_says_what_is_worse(self):
        class Answer(KeepAll):
            version = "1"

        before = self.run_into("before", [Answer])
        self.assertEqual(raymoval.compare(before, before).verdict, "no regression")

        class Answer(raymoval.Remover):
            version = "2"

            def run(self, scans, sink):
                for scan in scans:
                    sink.accept(scan.index, np.ones(len(scan), bool))

        after = self.run_into("after", [Answer])
        told = raymoval.compare(after, before)
        self.assertEqual((told.verdict, told.exit_code, told.same_cells), ("worse", 1, 3))
        self.assertTrue(any("answer" in line for line in told.worse), told.worse)
        missing = raymoval.compare(self.run_into("other", ["raymoval:online"]), before)
        self.assertEqual(missing.exit_code, 2)
        raised(self, raymoval.UsageError, "no such run folder", raymoval.compare, after, "nowhere")
        raised(self, raymoval.UsageError, "'parameters' or 'version'", raymoval.compare, after,
               after, across=["data"])

    def test_load_run(self):
        self.run_into("run", ["noop"])
        rows = raymoval.load_run(f"{self.folder}/run")
        try:
            import pandas
        except ImportError:
            self.assertIsInstance(rows, list)
        else:
            self.assertIsInstance(rows, pandas.DataFrame)
            rows = rows.to_dict("records")
        self.assertEqual({row["cell"] for row in rows}, {"noop", "remove-all", "oracle"}
                         if "noop" in {row["cell"] for row in rows} else
                         {"noop:default", "remove-all:default", "oracle:default"})
        file = Path(self.folder, "run", "results.json")
        file.write_text(file.read_text().replace("street", "strait"))
        raised(self, raymoval.DataError, "results.json", raymoval.load_run, f"{self.folder}/run")

    def test_arrays_cannot_be_run(self):
        arrays = raymoval.from_arrays([np.ones((3, 3), np.float32)], [np.eye(4)])
        raised(self, raymoval.UsageError, "made of arrays", raymoval.run, arrays, "noop", **QUIET)


class Sequences(unittest.TestCase):
    def test_what_a_sequence_tells(self):
        sequence = raymoval.open("street", frames="4:9:2", name="mine", **QUIET)
        self.assertEqual((len(sequence), sequence.name, sequence.has_labels), (3, "mine", True))
        self.assertEqual([scan.name for scan in sequence], ["000004", "000006", "000008"])
        self.assertEqual(sequence[-1].name, "000008")
        np.testing.assert_array_equal(sequence.poses[1], sequence[1].pose)
        np.testing.assert_allclose(raymoval.times(sequence, **QUIET), [0.4, 0.6, 0.8])
        self.assertEqual(sequence.up, "z")
        self.assertEqual(sequence.path, "street")
        self.assertRaises(IndexError, lambda: sequence[3])

    def test_what_cannot_be_opened(self):
        raised(self, raymoval.DataError, "Did you mean the scene 'street'?", raymoval.open, "stret",
               **QUIET)
        raised(self, raymoval.UsageError, "no option 'frame'", raymoval.open, "street", frame="0:1",
               **QUIET)
        raised(self, raymoval.UsageError, "", raymoval.open, "street", frames="few", **QUIET)

    def test_a_folder_of_files(self):
        with tempfile.TemporaryDirectory() as folder:
            points = np.array([[5, 0, 0, 0.5], [np.nan, 0, 0, 0], [6, 0, 0, 0.25]], np.float32)
            points.tofile(f"{folder}/000000.bin")
            Path(folder, "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
            sequence = raymoval.open(folder, sensor="vlp16", **QUIET)
            self.assertEqual(sequence[0].points[:, 0].tolist(), [5.0, 6.0])
            self.assertEqual(sequence[0].reflectance.tolist(), [0.5, 0.25])
            self.assertIsNone(sequence[0].labels)


if __name__ == "__main__":
    unittest.main()
