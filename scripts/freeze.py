#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Records the program's results, to check that a change alters none of them.

  scripts/freeze.py OUT                         records the results of build/release/raymoval in OUT
  scripts/freeze.py OUT --run BEFORE/run ...    draws tables, pictures and report from the run of an earlier record
  scripts/freeze.py OUT --drive FOLDER          also 60 scans of a labelled sequence of yours
  scripts/freeze.py OUT --cases FOLDER          also `inspect` and `clean` on each sequence in FOLDER
  scripts/freeze.py OUT --only PART             one of tables, corpus, cases, cells
  scripts/freeze.py OUT --scenes street,town    only these scenes, in place of nine

Two records are compared by `diff -r -x run BEFORE AFTER`. The program is build/release/raymoval, or what
RAYMOVAL says.

  tables/   tables (Markdown, CSV, LaTeX), pictures and report of a run on `street`
  corpus/   exit code and text of `inspect` and `clean` on the files of tests/fuzz/corpus, and digests of outputs
  cases/    the same for the sequences in FOLDER
  cells/    for every variant of every method, on `street` and on 30 scans of each other scene: digest of the
            masks, counts and rates of both protocols, figures by class, range and height
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("RAYMOVAL", ROOT / "build/release/raymoval")
SCENES = ["street", "town", "highway", "country", "suburb", "crossing", "excavator", "market", "warehouse"]


def call(*arguments):
    """Calls the program; its exit code may be any."""
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, errors="replace",
                          check=False)


def must(*arguments, allowed=(0,)):
    """Calls the program, and ends this script unless the exit code is allowed."""
    ended = call(*arguments)
    if ended.returncode not in allowed:
        raise SystemExit(f"freeze.py: raymoval {arguments[0]}: exit {ended.returncode}: {ended.stderr}")
    return ended.stdout


def variants():
    names = [line.split()[0] for line in must("list", "variants").splitlines() if line.strip()]
    return [name for name in names if not name.startswith("external")]


def freeze_cells(out, scenes, drive):
    sequences = [{"path": scene, "frames": "0:49" if scene == "street" else "0:29"} for scene in scenes]
    if drive:
        sequences.append({"path": str(drive.resolve()), "name": "drive", "frames": "0:59"})
    for sequence in sequences:
        name = sequence.get("name", sequence["path"])
        with tempfile.TemporaryDirectory() as work:
            suite = Path(work) / "suite.json"
            suite.write_text(json.dumps({"name": "freeze", "sequences": [sequence], "methods": variants(),
                                         "protocols": ["erasor", "dynamicmap"], "controls": True}))
            # A cell that fails is a result as well; then the exit code is 1.
            must("run", suite, "--quiet", "--jobs", os.cpu_count(), "--out", work + "/run", allowed=(0, 1))
            cells = json.loads(Path(work, "run", "results.json").read_text())["cells"]
        lines = []
        for cell in cells:
            kept = {key: cell[key] for key in ("name", "status", "reason", "masks", "protocols", "columns")}
            lines.append(json.dumps(kept, indent=1) + "\n")
        (out / f"{name}.json").write_text("".join(lines))
        print(f"cells of {name}: {len(cells)}", flush=True)


def freeze_tables(out, run):
    if not run:
        run = out.parent / "run"
        must("run", ROOT / "benchmark/suites/quick.json", "--quiet", "--keep-removals", "--out", run)
    for form in ("md", "csv", "tex"):
        (out / f"table.{form}").write_text(must("table", run, "--format", form))
    must("report", run, "-o", out / "report.html", "--quiet")
    must("picture", run, "-o", out / "map.png", "--quiet")
    for kind in ("pr-rr", "accuracy-time"):
        must("picture", run, "-o", out / f"{kind}.svg", "--kind", kind, "--quiet")
    print("tables", flush=True)


def record(sequence, label):
    """Exit codes and texts of `inspect` and `clean` on a sequence, and digests of what `clean` writes."""
    with tempfile.TemporaryDirectory() as work:
        commands = [["inspect", sequence],
                    ["clean", sequence, "-o", work + "/map.pcd", "--dynamic", work + "/dynamic.ply", "--labels",
                     work + "/labels", "--scans", work + "/scans", "--force", "--quiet"],
                    ["clean", sequence, "--labels", work + "/again", "--quiet"]]
        text = f"### {label}\n"
        for command in commands:
            ended = call(*command)
            text += f"# {command[0]}{' --force' if '--force' in command else ''}: exit {ended.returncode}\n"
            text += (ended.stdout + ended.stderr).replace(str(sequence), "PLACE").replace(work, "PLACE") + "\n"
        for file in sorted(p for p in Path(work).rglob("*") if p.is_file()):
            text += f"{file.relative_to(work)} {hashlib.sha256(file.read_bytes()).hexdigest()[:16]}\n"
    return re.sub(r"\b\d+(\.\d+)? (s|ms|min|MiB|GiB)\b", "N", text)


CLOUDS = {"bin": ".bin", "pcd": ".pcd", "pcd_records": ".pcd", "ply": ".ply", "ply_records": ".ply", "las": ".las",
          "npy": ".npy", "npz": ".npz"}
BAGS = {"bag_db3": ".db3", "bag_mcap": ".mcap", "bag_ros1": ".bag"}
BESIDE = {"poses": "poses.txt", "pose_formats": "poses.txt", "times": "times.txt", "calibration": "calib.txt",
          "sequence_json": "sequence.json"}


def corpus_sequence(kind, file, work, scans):
    """Makes a sequence with `file` in it; returns its path, or None for kinds that no sequence holds."""
    content = file.read_bytes()
    if kind in BAGS:
        place = work / ("corpus" + BAGS[kind])
        place.write_bytes(content)
        return place
    if kind not in CLOUDS and kind not in BESIDE:
        return None
    place = work / "corpus"
    folder, extension = (place / "velodyne", ".bin") if kind in BESIDE else (place, CLOUDS[kind])
    clouds = scans if kind in BESIDE else [content] * 2
    folder.mkdir(parents=True)
    for i, cloud in enumerate(clouds):
        (folder / f"{i:06}{extension}").write_bytes(cloud)
    (place / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n" * len(clouds))
    if kind in BESIDE:
        # The first byte of a file of pose_formats chooses the format; the poses begin behind it.
        (place / BESIDE[kind]).write_bytes(content[1:] if kind == "pose_formats" else content)
    return place


def freeze_corpus(out):
    with tempfile.TemporaryDirectory() as work:
        must("simulate", "town", "--sensor", "vlp16", "-o", work + "/town", "--scans", "4", "--quiet")
        scans = [file.read_bytes() for file in sorted(Path(work, "town", "velodyne").iterdir())]

    def one(file):
        with tempfile.TemporaryDirectory() as work:
            sequence = corpus_sequence(file.parent.name, file, Path(work), scans)
            return record(sequence, f"{file.parent.name}/{file.name}") if sequence else ""

    for folder in sorted((ROOT / "tests/fuzz/corpus").iterdir()):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            text = "".join(pool.map(one, sorted(folder.iterdir())))
        if text:
            (out / f"{folder.name}.txt").write_text(text)
    print("corpus", flush=True)


def freeze_cases(out, cases):
    places = sorted(place for place in cases.iterdir() if place.name not in ("truth", "answers"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for place, text in zip(places, pool.map(lambda place: record(place, place.name), places)):
            (out / f"{place.name}.txt").write_text(text)
    print(f"cases: {len(places)}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("--run", type=Path)
    parser.add_argument("--drive", type=Path)
    parser.add_argument("--cases", type=Path)
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--only", choices=("tables", "corpus", "cases", "cells"))
    asked = parser.parse_args()
    if asked.only == "cases" and not asked.cases:
        parser.error("--only cases needs --cases FOLDER")
    for part in ("tables", "corpus", "cases", "cells"):
        if asked.only not in (None, part) or (part == "cases" and not asked.cases):
            continue
        out = asked.out / part
        out.mkdir(parents=True, exist_ok=True)
        if part == "tables":
            freeze_tables(out, asked.run)
        elif part == "corpus":
            freeze_corpus(out)
        elif part == "cases":
            freeze_cases(out, asked.cases)
        else:
            freeze_cells(out, asked.scenes.split(","), asked.drive)


main()
