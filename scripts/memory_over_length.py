#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs methods on the first scans of a sequence, on twice and on four times as many, and prints a
table in Markdown of their memory and speed over the length.

    scripts/memory_over_length.py --out FOLDER [--sequence long] [--scans 4200] [--method NAME ...]
        [--program build/release/raymoval] [--threads 1] [--protocol NAME ...]

A method's peak memory is that of its own process at each length. From the last two lengths follow
the milliseconds that a late scan takes, and the bytes by which each more scan lets the memory grow:
those of the map that it adds, and of what is kept of each scan. Controls have no process of their own. With --protocol scoring's peak memory at
the whole length is measured, too, which takes its time.
"""

import argparse
import glob
import json
import os
import re
import subprocess
import sys
import time

METHODS = ["raymoval:online", "raymoval:offline", "raymoval_plus:offline",
           "raymoval_plus:online-map", "raymoval_plus:online", "raymoval_plus:online-lag",
           "erasor:general", "beautymap:published", "dynablox:published", "freedom:few-counts",
           "mapcleaner:sound", "hmm_mos:published", "dufomap:offline", "peopleremover:normals",
           "octomap:r20", "removert:rm3"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", required=True)
    parser.add_argument("--sequence", default="long")
    parser.add_argument("--scans", type=int, default=4200)
    parser.add_argument("--method", action="append")
    parser.add_argument("--program", default="build/release/raymoval")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--protocol", action="append", default=[])
    return parser.parse_args()


def own_peak(process):
    """Waits for a process. Returns its exit status and its own peak memory in MiB, without that of
    its children, which is what wait4 would add."""
    peak = 0
    while process.poll() is None:
        try:
            with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
                peak = max([peak] + [int(line.split()[1]) for line in status
                                     if line.startswith("VmHWM:")])
        except (FileNotFoundError, ProcessLookupError):
            pass  # It has just ended.
        time.sleep(0.02)
    return process.returncode, peak / 1024


def run(options, method, scans, protocols):
    """One cell. Returns what its cell.json says, and the peak memory of the scoring process."""
    name = f"{re.sub('[^a-z0-9_]+', '-', method)}-{scans}"
    suite = {"name": name, "methods": [method], "protocols": protocols, "controls": False,
             "sequences": [{"path": options.sequence, "name": name, "frames": f"0:{scans - 1}:1"}]}
    os.makedirs(options.out, exist_ok=True)
    file = os.path.join(options.out, name + ".json")
    with open(file, "w", encoding="utf-8") as output:
        json.dump(suite, output)
    folder = os.path.join(options.out, name)
    command = [options.program, "run", file, "--quiet", "--overwrite", "--threads",
               str(options.threads), "--out", folder]
    status, peak = own_peak(subprocess.Popen(command, stdout=subprocess.DEVNULL))
    if status != 0:
        sys.exit(f"{' '.join(command)}: ended with status {status}")
    cell, = glob.glob(os.path.join(folder, "cells", name, "*", "cell.json"))
    with open(cell, encoding="utf-8") as content:
        return json.load(content), peak


def row(options, method):
    lengths = [options.scans // 4, options.scans // 2, options.scans]
    cells = [run(options, method, scans, ["dynamicmap-strict"])[0] for scans in lengths]
    peaks = [cell["measured"]["peak_memory_mib"] for cell in cells]
    totals = [cell["measured"]["seconds_total"] for cell in cells]
    early = 1000 * totals[0] / lengths[0]
    late = 1000 * (totals[2] - totals[1]) / (lengths[2] - lengths[1])
    growth = (peaks[2] - peaks[1]) * 1048576 / (lengths[2] - lengths[1])
    columns = [" / ".join(f"{peak:.0f}" for peak in peaks), f"{growth:,.0f}", f"{early:.1f}",
               f"{late:.1f}"]
    if options.protocol:
        columns.append(f"{run(options, method, options.scans, options.protocol)[1]:.0f}")
    return columns


def main():
    options = arguments()
    columns = ["method", f"peak at {options.scans // 4:,} / {options.scans // 2:,} / "
               f"{options.scans:,} scans, MiB", "bytes a scan", "early, ms a scan",
               "late, ms a scan"]
    if options.protocol:
        columns.append("peak of scoring, MiB")
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|", flush=True)
    for method in options.method or METHODS:
        print(f"| {method} | " + " | ".join(row(options, method)) + " |", flush=True)


if __name__ == "__main__":
    main()
