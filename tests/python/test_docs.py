# SPDX-License-Identifier: MIT
"""The page on Python is true: its blocks of Python run, one after the other."""
import os
import re
import tempfile
import unittest
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "python.md"
SHELL = re.compile(r"(scripts/|/usr/bin/|cmake )")


def blocks():
    """The indented blocks of the page that are Python."""
    text = PAGE.read_text(encoding="utf-8")
    for found in re.finditer(r"(?:^(?: {4}.*)?\n)+", text, re.M):
        lines = [line[4:] for line in found.group().split("\n")]
        code = "\n".join(lines).strip("\n")
        if code and not SHELL.match(code):
            yield code


class Page(unittest.TestCase):
    def test_its_blocks_run(self):
        names = {"__name__": "page"}
        ran = 0
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                for block in blocks():
                    with self.subTest(block=block):
                        exec(compile(block, str(PAGE), "exec"), names)
                    ran += 1
            finally:
                os.chdir(before)
        self.assertGreaterEqual(ran, 5)
        self.assertEqual(len(names["static"]), 50)
        self.assertTrue(names["run"].good)


if __name__ == "__main__":
    unittest.main()
