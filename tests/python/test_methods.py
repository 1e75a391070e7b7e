# SPDX-License-Identifier: MIT
"""Methods in Python: what they are given, what is asked of them, and what their mistakes are told."""
import inspect
import os
import re
import subprocess
import sys
import threading
import traceback
import unittest

import numpy as np

import raymoval
from raymoval import _methods
from support import QUIET, KeepAll, NearPoints, raised, street, turned


def version(method):
    return _methods.entry(method)["version"]


class Tabled(NearPoints):
    """Holds something."""

    def __init__(self, table):
        self.table = table


class Contract(unittest.TestCase):
    def setUp(self):
        self.scans = [np.full((4 + i, 3), 5.0, np.float32) for i in range(3)]
        self.poses = np.stack([turned(0.0, [100.0 + i, 7.0, 2.0]) for i in range(3)])

    def clean(self, method):
        return raymoval.clean(self.scans, self.poses, method, sensor="vlp16", up="z", **QUIET)

    def answering(self, run):
        """A method that does what `run(scans, sink)` does."""
        made = KeepAll()
        made.run = run
        return self.clean(made)

    def test_what_a_method_sees(self):
        seen = {}

        def run(scans, sink):
            seen.update(count=len(scans), poses=scans.poses, sensor=scans.sensor.name,
                        last=scans[-1], threads=scans.threads)
            for scan in scans:
                sink.accept(scan.index, [0] * len(scan))

        self.answering(run)
        self.assertEqual((seen["count"], seen["sensor"]), (3, "vlp16"))
        # The first scan is at the origin.
        np.testing.assert_allclose(seen["poses"][:, :3, 3], [[0, 0, 0], [1, 0, 0], [2, 0, 0]])
        self.assertEqual(seen["last"].index, 2)
        self.assertEqual(seen["last"].points.shape, (6, 3))
        self.assertIsNone(seen["last"].labels)
        self.assertIsNone(seen["last"].moving)
        self.assertGreaterEqual(seen["threads"], 1)
        self.assertAlmostEqual(seen["last"].time, 0.2)

    def test_no_method_sees_a_label(self):
        seen = []

        class Looks(KeepAll):
            def run(self, scans, sink):
                seen.extend(scan.labels for scan in scans)
                super().run(scans, sink)

        raymoval.clean(street(2)[0], method=Looks, **QUIET)
        self.assertEqual(seen, [None, None])

    def test_masks_of_several_types_and_in_any_order(self):
        def run(scans, sink):
            sink.accept(2, np.array([1, 0, 0, 1, 0, 1], np.int64))
            sink.accept(0, np.array([1, 9, 0, 9, 0, 9, 1, 9], np.uint8)[::2])
            sink.accept(1, [True, False, False, True, False])

        masks = [mask.tolist() for mask in self.answering(run)]
        self.assertEqual(masks, [[True, False, False, True], [True, False, False, True, False],
                                 [True, False, False, True, False, True]])

    def test_masks_that_do_not_fit(self):
        def accept(*answers):
            def run(scans, sink):
                for scan, mask in answers:
                    sink.accept(scan, mask)

            return run

        whole = [(i, np.zeros(4 + i, bool)) for i in range(3)]
        for text, answers in {
                "scan 1: the mask has 4 values, expected one for each of the scan's 5 points":
                    [whole[0], (1, np.zeros(4, bool))],
                "gave no mask for scan 1 of 3": [whole[0], whole[2]],
                "scan 0: answered a second time": [whole[0], whole[0]],
                "there are only 3 scans": [(3, np.zeros(4, bool))],
                "neither 0 (kept) nor 1": [(0, [0, 1, 2, 0])]}.items():
            raised(self, raymoval.MethodError, text, self.answering, accept(*answers))
        raised(self, raymoval.UsageError, "the type float64", self.answering,
               accept((0, np.zeros(4))))
        raised(self, raymoval.UsageError, "the shape (4, 1)", self.answering,
               accept((0, np.zeros((4, 1), bool))))

    def test_an_exception_passes_through_with_its_traceback(self):
        def run(scans, sink):
            raise ZeroDivisionError("no scan today")

        frames = []
        try:
            self.answering(run)
        except ZeroDivisionError as error:
            self.assertEqual(str(error), "no scan today")
            frames = [frame.name for frame in traceback.extract_tb(error.__traceback__)]
        self.assertIn("run", frames)
        self.assertEqual(len(self.clean(KeepAll)), 3)  # All works as before.

    def test_scans_and_sink_end_with_the_run(self):
        kept = []

        class Keeps(KeepAll):
            def run(self, scans, sink):
                kept.extend([scans, sink, scans[0]])
                super().run(scans, sink)

        self.clean(Keeps)
        scans, sink, scan = kept
        raised(self, raymoval.UsageError, "is over", lambda: scans[0])
        raised(self, raymoval.UsageError, "is over", lambda: scans.poses)
        raised(self, raymoval.UsageError, "is over", sink.accept, 0, np.zeros(4, bool))
        self.assertEqual(scan.points.shape, (4, 3))  # A scan stays.

    def test_a_class_without_run(self):
        class Empty(raymoval.Remover):
            pass

        raised(self, NotImplementedError, "Empty has no run", self.clean, Empty)
        raised(self, raymoval.UsageError, "is no method", raymoval.run, "street", [object()],
               **QUIET)

    def test_many_threads_of_a_method(self):
        class Threads(raymoval.Remover):
            def run(self, scans, sink):
                def work(scan):
                    sink.accept(scan, np.zeros(len(scans[scan]), bool))

                threads = [threading.Thread(target=work, args=(i,)) for i in range(len(scans))]
                for thread in threads:
                    thread.start()
                for thread in threads:
                    thread.join()

        self.assertEqual(self.clean(Threads).removed_count, 0)

    def test_a_method_that_cleans_by_another(self):
        class Twice(raymoval.Remover):
            def run(self, scans, sink):
                masks = raymoval.clean([scan.points for scan in scans], scans.poses,
                                       NearPoints(), sensor="vlp16", up="z", **QUIET)
                for scan, mask in enumerate(masks):
                    sink.accept(scan, mask)

        self.assertEqual(self.clean(Twice).removed_count, 4 + 5 + 6)

    def test_what_is_told_of_progress(self):
        states = []
        sequence = street(4)[0]
        raymoval.clean(sequence, method=KeepAll, progress=states.append)
        self.assertTrue(states)
        self.assertEqual(states[-1].total, 0)

        def enough(state):
            raise LookupError("enough")

        raised(self, LookupError, "enough", raymoval.clean, sequence, method=KeepAll,
               progress=enough)


class Entries(unittest.TestCase):
    """What the harness asks of a method in Python."""

    def test_name_parameters_and_sentence(self):
        made = _methods.entry(NearPoints)
        self.assertEqual(made["name"], "near_points")
        self.assertEqual(made["sentence"], "Removes what is near.")
        self.assertEqual(made["parameters"], {"distance": 10.0})
        self.assertFalse(made["online"])
        other = made["make"]({"distance": 3.0})
        self.assertEqual((other.distance, NearPoints.distance), (3.0, 10.0))

    def test_the_version_is_that_of_the_code_and_of_what_is_held(self):
        self.assertNotEqual(version(NearPoints), version(KeepAll))
        self.assertEqual(version(Tabled([1])), version(Tabled([1])))
        self.assertNotEqual(version(Tabled([1])), version(Tabled([2])))
        changed = NearPoints()
        changed.distance = 3.0  # Parameters are stored separately.
        self.assertEqual(version(changed), version(NearPoints))
        changed.version = "7"
        self.assertEqual(version(changed), "7")

    def test_the_version_is_that_of_the_classes_below_too(self):
        class Farther(Tabled):
            pass

        self.assertNotEqual(version(Farther([1])), version(Tabled([1])))
        self.assertEqual(version(Farther([1])), version(Farther([1])))

    def test_what_cannot_be_read_or_stored_has_a_new_version_each_time(self):
        names = {"raymoval": raymoval, "__name__": "__main__"}
        exec("class Far(raymoval.Remover):\n    def run(self, scans, sink):\n        pass\n", names)
        self.assertNotEqual(version(names["Far"]), version(names["Far"]))
        locked = Tabled(threading.Lock())
        self.assertNotEqual(version(locked), version(locked))
        locked.version = "7"
        self.assertEqual(version(locked), "7")

    def test_the_version_is_the_same_in_each_process(self):
        text = ("import support\nfrom raymoval import _methods\n"
                "print(_methods.entry(support.NearPoints)['version'])\n")
        said = {subprocess.run([sys.executable, "-c", text], check=True, capture_output=True,
                               text=True, cwd=os.path.dirname(os.path.abspath(__file__)),
                               env={**os.environ, "PYTHONHASHSEED": str(seed)}).stdout
                for seed in range(3)}
        self.assertEqual(said, {version(NearPoints) + "\n"})


class Descriptions(unittest.TestCase):
    def test_every_name_can_be_described(self):
        for name in raymoval.methods():
            self.assertIn(name + " (version ", raymoval.describe(name))
        for name in raymoval.protocols():
            self.assertIn(name + " (version ", raymoval.describe("protocol:" + name))
        self.assertIn("  tau0 = ", raymoval.describe("raymoval:online"))

    def test_every_parameter_can_be_given_to_clean(self):
        own = set(inspect.signature(raymoval.clean).parameters) - {"parameters"}
        for name in raymoval.methods():
            described = set(re.findall(r"^  (\w+) = ", raymoval.describe(name), re.M))
            self.assertTrue(described or name.split(":")[0] in ("noop", "remove-all", "oracle"), name)
            self.assertEqual(own & described, set())

    def test_a_wrong_name(self):
        raised(self, raymoval.UsageError, "Did you mean 'dufomap'?", raymoval.describe, "dufomp")


if __name__ == "__main__":
    unittest.main()
