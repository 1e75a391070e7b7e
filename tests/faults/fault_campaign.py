#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lets the k-th call to the system fail, for each kind of call, each k and each of some commands.

A command must end with the right files and exit code 0, or with a message and another exit code;
nothing may stand half written under its final name, and the same command without a fault then ends
with the files of an undisturbed one. The last lines count what was tried.
"""
import argparse
import concurrent.futures
import os
import shutil
import struct
import sys
import tempfile
import threading
import time
import zlib

from fault_commands import COMMANDS, make_inputs, run, state, unfinished

# As fault_shim.cpp numbers them.
CALLS = ["open", "read", "write", "fsync", "rename", "stat", "mmap", "fork", "malloc", "mkdir",
         "unlink", "thread"]
DEPTHS = 4


def read_counts(file):
    """Counts of calls by depth and kind, and the number of faults."""
    with open(file, "rb") as opened:
        numbers = struct.unpack(f"<{DEPTHS * len(CALLS) + 1}Q",
                                opened.read(8 * (DEPTHS * len(CALLS) + 1)))
    rows = [numbers[i * len(CALLS):(i + 1) * len(CALLS)] for i in range(DEPTHS)]
    return rows, numbers[-1]


class Campaign:
    def __init__(self, arguments, work):
        self.arguments = arguments
        self.work = work
        self.base = os.path.join(work, "base")
        self.environment = {**os.environ, "RAYMOVAL_CACHE": os.path.join(work, "cache"),
                            "TMPDIR": os.path.join(work, "tmp"), "LC_ALL": "C"}
        os.makedirs(self.environment["TMPDIR"])
        make_inputs(arguments.program, self.base, self.environment)
        self.before, self.expected = {}, {}
        self.tally = {}
        self.tried = 0
        self.bad = []
        self.lock = threading.Lock()

    def shimmed(self, folder, **more):
        """The environment with the library that counts, and the file in which it does."""
        counts = folder + ".counts"
        with open(counts, "wb") as file:
            file.write(bytes(4096))
        return {**self.environment, "LD_PRELOAD": self.arguments.shim,
                "RAYMOVAL_FAULT_COUNTS": counts, **more}, counts

    def folder(self):
        return os.path.join(self.work, f"case-{threading.get_ident()}")

    def undisturbed(self, command):
        """Runs a command as it is. Returns (depth, call, k) of all that is to fail."""
        folder = self.folder()
        command.prepare(self.base, folder)
        self.before[command.name] = state(folder)
        environment, counts_file = self.shimmed(folder)
        code, _, text = run(self.arguments.program, command.arguments, folder, environment)
        if code != 0:
            raise SystemExit(f"fault_campaign.py: {command.name}: exit code {code}: {text}")
        self.expected[command.name] = state(folder)
        counts, _ = read_counts(counts_file)
        points = []
        for depth in range(DEPTHS):
            for call, count in zip(CALLS, counts[depth]):
                if self.arguments.calls and call not in self.arguments.calls:
                    continue
                numbers = range(1, count + 1)
                if call == "malloc" and count > 0:
                    numbers = self.allocations(command, depth)
                points += [(depth, call, k) for k in self.chosen(command, depth, call, numbers)]
        return points

    def allocations(self, command, depth):
        """Numbers of the first allocation that each chain of callers asks for."""
        if self.arguments.sample and not self.arguments.places:
            return range(1, 3000)  # What is near to the begin, which takes no second run.
        folder = self.folder()
        command.prepare(self.base, folder)
        places = folder + ".places"
        if os.path.exists(places):
            os.remove(places)
        environment, _ = self.shimmed(folder, RAYMOVAL_FAULT_PLACES=places,
                                      RAYMOVAL_FAULT_AT=str(depth))
        run(self.arguments.program, command.arguments, folder, environment, 300)
        with open(places, "rb") as file:
            raw = file.read()
        return sorted(set(struct.unpack(f"<{len(raw) // 8}Q", raw)))

    def chosen(self, command, depth, call, numbers):
        """All of them, or some that are spread over the whole and always the same."""
        most = self.arguments.sample
        numbers = list(numbers)
        if not most or len(numbers) <= most:
            return numbers
        first = zlib.crc32(f"{command.name} {depth} {call}".encode()) % len(numbers)
        return [numbers[(first + i * len(numbers) // most) % len(numbers)] for i in range(most)]

    def files_problem(self, command, code, text, found):
        """What is wrong with the files that a command left; empty if nothing is."""
        before, expected = self.before[command.name], self.expected[command.name]
        whole = {name: one for name, one in found.items() if name not in unfinished(found)}
        if code == 0:
            wrong = sorted(name for name in {*whole, *expected}
                           if whole.get(name) != expected.get(name))
            return f"exit 0 with other files: {wrong}" if wrong else ""
        for name, one in whole.items():
            if one is None:
                return f"{name} is damaged"
            known = name in expected or name in before
            same = one in (expected.get(name), before.get(name))
            result = command.has_cells and name.endswith((".json", ".csv", ".md", ".tex"))
            if not result and not (known and same):
                return f"{name} is neither as before nor as it should be"
        if command.name == "clean" and whole not in (before, expected):
            return "some outputs are replaced and others not"
        if "Nothing was changed" in text and command.name == "clean" and whole != before:
            return "it says that nothing was changed"
        return ""

    def again_problem(self, command, folder, found):
        """The same command without a fault, after one."""
        expected = self.expected[command.name]
        if command.once and all(found.get(name) == one for name, one in expected.items()):
            return ""
        code, _, text = run(self.arguments.program, command.arguments, folder, self.environment)
        if code != 0:
            return f"again: exit code {code}: {text.strip()[-300:]}"
        after = state(folder)
        left = unfinished(after)
        if left and command.has_cells:
            return f"again: left {left}"
        wrong = sorted(name for name in {*after, *expected}
                       if after.get(name) != expected.get(name) and name not in left)
        return f"again: other files: {wrong}" if wrong else ""

    def problem(self, command, folder, code, text):
        if code is None:
            return "it hangs"
        if code not in (0, 1, 2):
            return f"exit code {code}"
        if code != 0 and not any(line.startswith("raymoval: ") for line in text.splitlines()):
            return f"exit code {code} without a message"
        found = state(folder)
        return (self.files_problem(command, code, text, found) or
                self.again_problem(command, folder, found))

    def try_one(self, command, point):
        depth, call, k = point
        folder = self.folder()
        command.prepare(self.base, folder)
        environment, counts_file = self.shimmed(folder, RAYMOVAL_FAULT=f"{call},{depth},{k}")
        code, _, text = run(self.arguments.program, command.arguments, folder, environment)
        _, faults = read_counts(counts_file)
        problem = self.problem(command, folder, code, text)
        outcome = "bad" if problem else "missed" if faults == 0 else "done" if code == 0 else "told"
        with self.lock:
            row = self.tally.setdefault((command.name, call), dict.fromkeys(
                ("done", "told", "bad", "missed"), 0))
            row[outcome] += 1
            self.tried += 1
            if self.tried % 500 == 0:
                print(f"{self.tried} tried, {len(self.bad)} of them bad", flush=True)
            if problem:
                self.bad.append((command.name, depth, call, k))
                print(f"BAD {command.name}: {call} {k} at depth {depth}: {problem}\n"
                      f"    exit code {code}: {text.strip()[-400:]}", flush=True)

    def tables(self):
        print(f"{'command':10} {'call':8} {'faults':>7} {'right':>7} {'told':>7} {'bad':>5} "
              f"{'not reached':>12}")
        sums = dict.fromkeys(("done", "told", "bad", "missed"), 0)
        for (name, call), row in sorted(self.tally.items()):
            faults = row["done"] + row["told"] + row["bad"]
            print(f"{name:10} {call:8} {faults:7} {row['done']:7} {row['told']:7} {row['bad']:5} "
                  f"{row['missed']:12}")
            for key in sums:
                sums[key] += row[key]
        print(f"{sums['done'] + sums['told'] + sums['bad']} faults: {sums['done']} with the right "
              f"result, {sums['told']} with an error that was told, {sums['bad']} bad.")


def parsed():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("shim")
    parser.add_argument("--sample", type=int, default=0, metavar="N",
                        help="try N faults of each kind of call and command (default: all)")
    parser.add_argument("--places", action="store_true",
                        help="with --sample: find the places of all allocations, too")
    parser.add_argument("--commands", default="", help="such as run,clean (default: all)")
    parser.add_argument("--calls", default="", help="such as open,stat (default: all)")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=1e9,
                        help="begin nothing new after this time")
    arguments = parser.parse_args()
    arguments.program = os.path.realpath(arguments.program)
    arguments.shim = os.path.realpath(arguments.shim)
    arguments.calls = [one for one in arguments.calls.split(",") if one]
    names = [one for one in arguments.commands.split(",") if one]
    arguments.commands = [one for one in COMMANDS if not names or one.name in names]
    return arguments


def main():
    arguments = parsed()
    started = time.monotonic()
    skipped = 0
    results = []
    work = tempfile.mkdtemp(prefix="raymoval-faults-")
    try:
        campaign = Campaign(arguments, work)
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            for command in arguments.commands:
                points = campaign.undisturbed(command)
                print(f"{command.name}: {len(points)} faults", flush=True)
                for point in points:
                    def work_on(one=point, on=command):
                        if time.monotonic() - started > arguments.seconds:
                            return 1
                        campaign.try_one(on, one)
                        return 0
                    results.append(pool.submit(work_on))
            for result in results:
                skipped += result.result()
        campaign.tables()
        if skipped:
            print(f"{skipped} faults were left out, because the time was over.")
        return 1 if campaign.bad else 0
    finally:
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
