#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Scores what the program scores, in plain Python, and compares every count and rate.

    second_opinion.py PROGRAM hostile [NAME...]      small sequences that are hard to score
    second_opinion.py PROGRAM street FRAMES          the built-in scene, with removals at random
    second_opinion.py PROGRAM folder DIR FRAMES      a sequence in SemanticKITTI layout, likewise

FRAMES is FIRST:LAST:STRIDE. It exits with 1 if anything differs.
"""
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True  # The source tree is not changed.

import dynamicmap
import dynamicmap_strict
import erasor
import hostile
import mos
import points
import sequence_files

PROTOCOLS = {"erasor": erasor, "dynamicmap": dynamicmap, "dynamicmap-strict": dynamicmap_strict,
             "mos": mos}


def text_of(value):
    """A setting as the command line wants it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def cleaned_map(sequence):
    """Points of the map that an answer leaves, in the world, and some in the air."""
    kept = [scan.world(*point) for scan, point, _, removed in sequence_files.returns(sequence)
            if not removed]
    return kept + [(x + 0.25, y, z + 6.5) for x, y, z in kept[::7]]


def scored(program, folder, answer, settings, protocols=PROTOCOLS):
    """What `raymoval score` says, as JSON. The answer is a folder of labels or a map."""
    with tempfile.TemporaryDirectory() as out:
        result = Path(out) / "score.json"
        kind = "--predictions" if answer.is_dir() else "--cloud"
        command = [program, "score", "--sequence", folder, kind, answer, "--json", result,
                   "--quiet"]
        for name in protocols:
            command += ["--protocol", name]
        for name, options in settings.items():
            if name not in protocols:
                continue
            for key, value in options.items():
                command += ["--set", f"protocol:{name}.{key}={text_of(value)}"]
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(str(part) for part in command)}: {done.stderr}")
        return json.loads(result.read_text())


def close(a, b):
    """Whether two rates are the same but for the last digits of a double."""
    if a is None or b is None:
        return a is b
    return math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-12)


def differences(said, sequence, settings, classes=True, names=None,
                cloud=None):
    """Lines about what the program and the second opinion do not agree on; and how many counts
    were compared. Without classes, columns of single classes and of objects are left out."""
    lines, compared = [], 0
    for protocol in said["protocols"]:
        module = PROTOCOLS[protocol["name"]]
        asked = dict(settings.get(protocol["name"], {}))
        if cloud is not None:
            asked["cloud"] = cloud
            if protocol["name"] == "erasor":
                asked.setdefault("lift", 0.0)  # A map carries none.
        counts = module.score(sequence, **asked)
        for key, value in protocol["counts"].items():
            compared += 1
            if value != counts.get(key, 0):
                lines.append(f"{protocol['name']} {key}: {value}, in Python {counts.get(key, 0)}")
        lines += [f"{protocol['name']} {key}: unknown" for key in counts.keys()
                  - protocol["counts"].keys()]
        rates = module.rates(counts)
        for key, value in protocol["rates"].items():
            if key not in rates or not close(value, rates[key]):
                lines.append(f"{protocol['name']} {key}: {value}, in Python {rates.get(key)}")
    mine = points.values(sequence, names, cloud)
    theirs = {name: (value["part"], value["whole"])
              for name, value in said["columns"]["values"].items()}
    for name in sorted(mine.keys() | theirs.keys()):
        if not classes and name.split()[0] in ("parked", "trails"):
            continue
        if not classes and "[" in name and name.split("[")[1].split()[0] not in ("range", "height", "time"):
            continue
        compared += 1
        if mine.get(name, (0, 0)) != theirs.get(name, (0, 0)):
            lines.append(f"columns {name}: {theirs.get(name)}, in Python {mine.get(name)}")
    return lines, compared


def tell(name, lines, compared):
    """Prints what differs; returns whether nothing does."""
    print(f"{name}: {compared} counts compared, {len(lines)} differ", flush=True)
    for line in lines:
        print(f"  {line}")
    return not lines


def check_case(program, case, place, seed):
    """Compares a hostile sequence with all its settings; returns whether all is equal."""
    folder, answers = place / "sequence", place / "answers"
    hostile.write(case, folder, answers, seed)
    shown, names = folder, None
    if case.layout == "dynamicmap":
        shown = place / "clouds"
        names = {}  # 1 moves; there are no classes.
    sequence = sequence_files.read_sequence(folder, answers)
    good, answer, cloud, protocols = True, answers, None, PROTOCOLS
    if case.as_cloud:
        cloud = cleaned_map(sequence)
        answer = place / "cloud.bin"
        answer.write_bytes(b"".join(struct.pack("<4f", *point, 0) for point in cloud))
        protocols = ("erasor", "dynamicmap")  # The third goes by index.
    for settings in case.settings:
        said = scored(program, shown, answer, settings, protocols)
        lines, compared = differences(said, sequence, settings, names=names, cloud=cloud)
        for protocol in said["protocols"][:2]:
            for name, rate in protocol["rates"].items():
                expected = case.expected.get(name, rate)
                if case.expected and abs(rate - expected) > 0.0005:
                    lines.append(f"{name}: {rate}, by hand {expected}")
        good &= tell(f"{case.name} {json.dumps(settings)}", lines, compared)
    return good


def check_hostile(program, names):
    """All hostile sequences, or those that are named."""
    good, found = True, 0
    for seed, case in enumerate(hostile.cases()):
        if names and case.name not in names:
            continue
        found += 1
        with tempfile.TemporaryDirectory() as place:
            good &= check_case(program, case, Path(place), seed)
    return good and found > 0


def run(program, sequence, frames, out, copy=None):
    """Runs the method at random and the controls; returns the folder of cells."""
    here = Path(__file__).resolve().parent
    command = [program, "run", "--sequence", sequence, "--frames", frames, "--name", "it", "--out",
               out, "--method", f"external:{here}/random_method.json", "--keep-removals", "--quiet"]
    for name in PROTOCOLS:
        command += ["--protocol", name]
    environment = {**os.environ, "RAYMOVAL_PYTHON": sys.executable}
    if copy:
        environment["OPINION_COPY"] = str(copy)
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          env=environment)
    if done.returncode != 0:
        raise RuntimeError(done.stdout + done.stderr)
    return next(Path(out).glob("cells/*"))


def cell_in(cells, name):
    """The folder of the cell of a method."""
    return next(path for path in cells.iterdir() if path.name.startswith(name))


def check_folder(program, folder, frames):
    """Compares what a run says of a sequence whose files can be read here."""
    with tempfile.TemporaryDirectory() as out:
        cell = cell_in(run(program, folder, frames, Path(out) / "run"), "at-random")
        first, last, stride = (int(number) for number in frames.split(":"))
        sequence = sequence_files.read_sequence(folder, cell / "removals", first, last, stride)
        lines, compared = differences(json.loads((cell / "cell.json").read_text()), sequence, {})
    return tell(f"{folder} {frames}", lines, compared)


STREET_SENSOR = (0.0, 0.0, 1.8)  # where the street's first scan is taken, metres
STREET_STEP = 1.0  # metres from scan to scan, along x


def complete_street(cells, copy, answers, frames):
    """Makes the copy that the external method was given a sequence with poses in the street's own
    world and with labels: the oracle removes what moves. Answers get the numbers of the copy."""
    first = frames[0]
    shift = (STREET_SENSOR[0] + STREET_STEP * first, *STREET_SENSOR[1:])
    poses = [[float(number) for number in line.split()]
             for line in (copy / "poses.txt").read_text().splitlines()]
    for pose in poses:
        for row in range(3):
            pose[4 * row + 3] += shift[row]
    lines = (" ".join(repr(number) for number in pose) for pose in poses)
    (copy / "poses.txt").write_text("\n".join(lines))
    (copy / "labels").mkdir()
    answers.mkdir()
    for number, frame in enumerate(frames):
        name = f"removals/{frame:06d}.label"
        words = sequence_files.read_words(cell_in(cells, "oracle") / name)
        labels = struct.pack(f"<{len(words)}I", *(252 if word == 251 else 40 for word in words))
        (copy / "labels" / f"{number:06d}.label").write_bytes(labels)
        shutil.copy(cell_in(cells, "at-random") / name, answers / f"{number:06d}.label")


def check_street(program, frames):
    """Compares on the built-in scene, of which there are no files: an external method is given the
    scans and poses, and the oracle tells what moves."""
    first, last, stride = (int(number) for number in frames.split(":"))
    with tempfile.TemporaryDirectory() as place:
        copy, answers = Path(place) / "copy", Path(place) / "answers"
        copy.mkdir()
        cells = run(program, "street", frames, Path(place) / "run", copy)
        complete_street(cells, copy, answers, range(first, last + 1, stride))
        sequence = sequence_files.read_sequence(copy, answers)
        said = json.loads((cell_in(cells, "at-random") / "cell.json").read_text())
    lines, compared = differences(said, sequence, {}, classes=False)
    return tell(f"street {frames}", lines, compared)


def main():
    program, what, *rest = sys.argv[1:]
    if what == "hostile":
        return check_hostile(program, rest)
    if what == "street":
        return check_street(program, *rest)
    return check_folder(program, *rest)


if __name__ == "__main__":
    sys.exit(0 if main() else 1)
