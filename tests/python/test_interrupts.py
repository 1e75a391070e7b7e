# SPDX-License-Identifier: MIT
"""Ctrl-C, threads and forks."""
import os
import signal
import subprocess
import sys
import threading
import time
import unittest


import raymoval
from support import QUIET, KeepAll, NearPoints, street


def interrupted(case, function, *arguments, **named):
    """Calls `function`, to which `progress` is given, and presses Ctrl-C once it is at work."""
    pressed = []

    def press(state):
        if not pressed:
            pressed.append(state)
            os.kill(os.getpid(), signal.SIGINT)

    with case.assertRaises(KeyboardInterrupt):
        function(*arguments, progress=press, **named)
    case.assertTrue(pressed)


class CtrlC(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sequence = street(50)[0]

    def test_a_built_in_method(self):
        interrupted(self, raymoval.clean, self.sequence, method="raymoval:offline")
        self.assertEqual(len(raymoval.clean(self.sequence, method="noop", **QUIET)), 50)

    def test_a_run(self):
        interrupted(self, raymoval.run, self.sequence, ["raymoval:offline", "octomap"])

    def test_a_method_in_python_that_never_ends(self):
        ended = []

        class Endless(KeepAll):
            def run(self, scans, sink):
                try:
                    while True:
                        pass
                finally:
                    ended.append(True)

        interrupted(self, raymoval.clean, self.sequence, method=Endless)
        self.assertEqual(ended, [True])

    def test_a_method_that_catches_all_errors(self):
        class Stubborn(KeepAll):
            def run(self, scans, sink):
                while True:
                    try:
                        scans[0]
                    except Exception:
                        pass

        interrupted(self, raymoval.clean, self.sequence, method=Stubborn)

    def test_scans_that_are_made_while_it_works(self):
        scans = [scan.points.copy() for scan in self.sequence]

        class Slow:
            def __len__(self):
                return len(scans)

            def __getitem__(self, index):
                time.sleep(0.01)
                return scans[index]

        interrupted(self, raymoval.clean, Slow(), self.sequence.poses, method="noop", up="z",
                    sensor="vlp16")


class Threads(unittest.TestCase):
    def test_two_at_once_answer_as_one(self):
        sequence, scans, poses = street()
        expected = [m.tolist() for m in raymoval.clean(sequence, method="raymoval:online", **QUIET)]
        answers = {}

        def work(number):
            own = sequence if number % 2 else raymoval.open("street", frames="0:11", **QUIET)
            made = raymoval.clean(own, method="raymoval:online", **QUIET)
            answers[number] = [mask.tolist() for mask in made]

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([answers[i] == expected for i in range(4)], [True] * 4)

    def test_other_threads_go_on(self):
        sequence = street()[0]
        ticks = []
        done = threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(None)
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        raymoval.clean(sequence, method="raymoval:offline", **QUIET)
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 3)


class Forks(unittest.TestCase):
    def test_a_child_cleans_after_its_parent_did(self):
        sequence = street()[0]
        expected = [m.tolist() for m in raymoval.clean(sequence, method="raymoval:online", **QUIET)]
        child = os.fork()
        if child == 0:
            same = [m.tolist() for m in raymoval.clean(sequence, method="raymoval:online", **QUIET)]
            os._exit(0 if same == expected else 1)
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                self.assertEqual(os.waitstatus_to_exitcode(status), 0)
                return
            time.sleep(0.01)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        self.fail("the child hangs")


class Ends(unittest.TestCase):
    def test_the_interpreter_ends_with_objects_alive(self):
        text = ("import numpy, raymoval\n"
                "s = raymoval.from_arrays([numpy.ones((3, 3), numpy.float32)], [numpy.eye(4)])\n"
                "class Own(raymoval.Remover):\n"
                "    def run(self, scans, sink):\n"
                "        global kept; kept = scans\n"
                "        sink.accept(0, [1, 0, 1])\n"
                "m = raymoval.clean(s, method=Own, progress=False)\n"
                "p = s[0].points\n"
                "print(m[0].sum())\n")
        made = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True)
        self.assertEqual((made.returncode, made.stdout, made.stderr), (0, "2\n", ""))


if __name__ == "__main__":
    unittest.main()
