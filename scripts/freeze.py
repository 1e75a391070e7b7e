#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Records what the program answers, so that a change that is to change no number can be checked.

  scripts/freeze.py OUT                         records the answers of build/release/raymoval in OUT
  scripts/freeze.py OUT --run BEFORE/run ...    draws tables and report from the run of an earlier record
  scripts/freeze.py OUT --drive FOLDER          also 60 scans of a labelled sequence of yours
  scripts/freeze.py OUT --cases FOLDER          also `inspect` and `clean` on each sequence in FOLDER
  scripts/freeze.py OUT --only PART             one of cells, tables, corpus, cases
  scripts/freeze.py OUT --scenes street,town    only these scenes, in place of nine
  scripts/freeze.py OUT --program FILE          another program

Then `diff -r BEFORE AFTER -x run`: no output, if nothing changed.

  cells/    for every variant of every method, on `street` and on 30 scans of each scene: digest of the masks,
            counts and rates of both protocols, figures by class, range and height
  tables/   results.csv, table.md, table.tex and report.html of the run `street`, made again
  corpus/   exit code and text of `inspect` and `clean` on the files of tests/fuzz/corpus, and digests of outputs
  cases/    the same for the sequences in FOLDER
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["street", "town", "highway", "country", "suburb", "crossing", "excavator", "market", "warehouse"]


def call(*arguments, **more):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, errors="replace", check=False,
                          **more)


def variants(program):
    lines = call(program, "list", "variants").stdout.splitlines()
    names = [line.split()[0] for line in lines if line.strip()]
    return [name for name in names if not name.startswith("external")]


def without_times(value):
    """Drops what two runs of one program do not share."""
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in ("measured", "key", "program", "build")}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def freeze_cells(program, out, scenes, drive):
    sequences = [{"path": scene, "frames": "0:49" if scene == "street" else "0:29"} for scene in scenes]
    if drive:
        sequences.append({"path": str(drive), "name": "drive", "frames": "0:59"})
    for sequence in sequences:
        name = sequence.get("name", sequence["path"])
        suite = out / "suite.json"
        suite.write_text(json.dumps({"name": "freeze", "sequences": [sequence], "methods": variants(program),
                                     "protocols": ["erasor", "dynamicmap"], "controls": True}))
        with tempfile.TemporaryDirectory() as work:
            ended = call(program, "run", suite, "--quiet", "--jobs", os.cpu_count(), "--out", work)
            if ended.returncode not in (0, 1):
                raise SystemExit(f"{name}: {ended.stderr}")
            cells = json.loads((Path(work) / "results.json").read_text())["cells"]
        (out / "cells").mkdir(exist_ok=True)
        lines = []
        for cell in cells:
            kept = {k: cell[k] for k in ("sequence", "name", "status", "reason", "masks", "protocols", "columns")
                    if k in cell}
            lines.append(json.dumps(without_times(kept), indent=1, sort_keys=True))
        (out / "cells" / f"{name}.json").write_text("\n".join(lines) + "\n")
        suite.unlink()
        print(f"cells of {name}: {len(cells)}", flush=True)


def freeze_tables(program, out, run):
    if not run:
        run = out / "run"
        ended = call(program, "run", ROOT / "benchmark/suites/quick.json", "--quiet", "--keep-removals", "--out", run)
        if ended.returncode:
            raise SystemExit(ended.stderr)
    tables = out / "tables"
    tables.mkdir(exist_ok=True)
    for form in ("md", "csv", "tex"):
        ended = call(program, "table", run, "--format", form)
        (tables / f"table.{form}").write_text(ended.stdout + ended.stderr)
    method = ["--method", "raymoval:offline"]
    drawn = [("report", run, "-o", tables / "report.html"), ("picture", run, "-o", tables / "map.png"),
             ("picture", run, "-o", tables / "range.png", "--kind", "range", *method),
             ("picture", run, "-o", tables / "overview.png", "--kind", "overview", *method)]
    drawn += [("picture", run, "-o", tables / f"{kind}.{form}", "--kind", kind)
              for kind in ("pr-rr", "stages", "accuracy-time") for form in ("svg", "png", "pdf")]
    text = ""
    for arguments in drawn:
        ended = call(program, *arguments, "--quiet")
        text += f"{arguments[0]} {Path(arguments[3]).name}: exit {ended.returncode} {ended.stderr}\n"
    (tables / "messages.txt").write_text(text)
    print("tables", flush=True)


def tidy(text, *places):
    for place in places:
        text = text.replace(str(place), "PLACE")
    text = re.sub(r"\b\d+(\.\d+)? (s|ms|min|MiB|GiB)\b", "N", text)
    return text


def record(program, sequence, label):
    """What `inspect` and `clean` make of a sequence, as a text."""
    with tempfile.TemporaryDirectory() as work:
        parts = []
        inspected = call(program, "inspect", sequence, timeout=600)
        parts.append(("inspect", inspected))
        outputs = [work + "/map.pcd", work + "/dynamic.ply", work + "/labels", work + "/scans"]
        cleaned = call(program, "clean", sequence, "-o", outputs[0], "--dynamic", outputs[1], "--labels", outputs[2],
                       "--scans", outputs[3], "--force", "--quiet", timeout=1800)
        parts.append(("clean --force", cleaned))
        plain = call(program, "clean", sequence, "--labels", work + "/again", "--quiet", timeout=1800)
        parts.append(("clean", plain))
        text = f"### {label}\n"
        for name, ended in parts:
            text += f"# {name}: exit {ended.returncode}\n" + tidy(ended.stdout + ended.stderr, sequence, work) + "\n"
        for file in sorted(p for p in Path(work).rglob("*") if p.is_file()):
            text += f"{file.relative_to(work)} {hashlib.sha256(file.read_bytes()).hexdigest()[:16]}\n"
        return text


CLOUDS = {"bin": ".bin", "pcd": ".pcd", "pcd_records": ".pcd", "ply": ".ply", "ply_records": ".ply", "las": ".las",
          "npy": ".npy", "npz": ".npz", "gz": ".pcd.gz"}
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
    (place / "velodyne").mkdir(parents=True)
    for i, scan in enumerate(scans):
        (place / "velodyne" / f"{i:06}.bin").write_bytes(scan)
    (place / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n" * len(scans))
    if kind in BESIDE:
        # The first byte of these names the form that the user says.
        (place / BESIDE[kind]).write_bytes(content[1:] if kind == "pose_formats" else content)
        return place
    shutil.rmtree(place / "velodyne")
    for i in range(2):
        (place / f"{i:06}{CLOUDS[kind]}").write_bytes(content)
    (place / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n" * 2)
    return place


def freeze_corpus(program, out):
    street = Path(tempfile.mkdtemp())
    call(program, "simulate", "town", "--sensor", "vlp16", "-o", street / "s", "--scans", "4", "--quiet")
    scans = [f.read_bytes() for f in sorted((street / "s" / "velodyne").iterdir())][:4]
    shutil.rmtree(street)
    (out / "corpus").mkdir(exist_ok=True)

    def one(kind, file):
        with tempfile.TemporaryDirectory() as work:
            sequence = corpus_sequence(kind, file, Path(work), scans)
            return record(program, sequence, f"{kind}/{file.name}") if sequence else ""

    for folder in sorted((ROOT / "tests/fuzz/corpus").iterdir()):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            texts = list(pool.map(lambda f, k=folder.name: one(k, f), sorted(folder.iterdir())))
        if any(texts):
            (out / "corpus" / f"{folder.name}.txt").write_text("".join(texts))
    print("corpus", flush=True)


def freeze_cases(program, out, cases):
    (out / "cases").mkdir(exist_ok=True)
    names = sorted(p for p in cases.iterdir() if p.name not in ("truth", "answers"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for place, text in zip(names, pool.map(lambda p: record(program, p, p.name), names)):
            (out / "cases" / f"{place.name}.txt").write_text(text)
    print(f"cases: {len(names)}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/raymoval")
    parser.add_argument("--run", type=Path)
    parser.add_argument("--drive", type=Path)
    parser.add_argument("--cases", type=Path)
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--only", choices=("cells", "tables", "corpus", "cases"))
    asked = parser.parse_args()
    asked.out.mkdir(parents=True, exist_ok=True)
    parts = {"tables": lambda: freeze_tables(asked.program, asked.out, asked.run),
             "corpus": lambda: freeze_corpus(asked.program, asked.out),
             "cases": lambda: freeze_cases(asked.program, asked.out, asked.cases) if asked.cases else None,
             "cells": lambda: freeze_cells(asked.program, asked.out, asked.scenes.split(","), asked.drive)}
    for name, part in parts.items():
        if asked.only in (None, name):
            part()


main()
