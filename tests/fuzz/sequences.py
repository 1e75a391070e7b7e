# SPDX-License-Identifier: MIT
"""Damages whole sequences at random (bytes, sizes, names, numbers in texts) in each layout, and gives them to
`raymoval inspect`, `run`, `clean` and `score`, with limits on time and memory.

    sequences.py PROGRAM COUNT SEED FOLDER

The outcome of each command has to be exit code 0 with finite numbers, or 1 or 2 with a message; and data on which a
cell fails has to give a finding of `inspect`. The same seed gives the same sequences. What fails is kept in
FOLDER/SEED-NUMBER, and then the exit code is 1. SANITIZERS=1 is for a program with the sanitizers."""
import json
import math
import os
import random
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SANITIZERS = os.environ.get("SANITIZERS", "") not in ("", "0")
SECONDS = 300 if SANITIZERS else 60
MEMORY = 3 << 30  # Bytes of address space; the sanitizers reserve more than there is.
SCANS = 5
POINTS = 400  # Of a scan: few enough for a thousand sequences.
METHODS = ["raymoval:online", "raymoval:offline", "raymoval_plus:offline", "octomap", "octomap:ground-noise",
           "peopleremover:normals", "peopleremover:plain", "dufomap:online", "dufomap:offline", "erasor", "removert"]
NUMBERS = ("nan", "inf", "-inf", "1e309", "1e308", "-1e308", "1e16", "1e-320", "0", "-0", "-1", "1e6",
           "99999999999999999999", "0x10", "1,5", "", "1e", "+", "1e1000000", "4294967296", "2147483648",
           "1 2", "'", "\x1b[31m", "3" * 400)
FLOATS = (math.nan, math.inf, -math.inf, 1e30, 3e38, 1e-45, 1e-27, -0.0, 0.0, 1e6, 2e5, 1.2e4, 1e9, 1e16)
TEXTS = ("", " ", "=1", "-x", "..", "/etc/passwd", "a/b", "\x1b[31m", "\u202ex", "x" * 300, "<b>", "é",
         "estimated", "hdl64e", "z", "-y", "auto", "2:40", "poses.txt", "nan")
KEYS = ("name", "source", "sensor", "up", "scan_period_s", "poses", "poses_are_lidar", "range_m", "labels",
        "drop_ego", "nonsense")


# Good sequences, one in each layout.


def read_scans(folder):
    """Points and labels of a SemanticKITTI folder, thinned to POINTS a scan."""
    scans = []
    for path in sorted((folder / "velodyne").iterdir()):
        rows = list(struct.iter_unpack("<4f", path.read_bytes()))
        words = list(struct.iter_unpack("<I", (folder / "labels" / (path.stem + ".label")).read_bytes()))
        chosen = range(0, len(rows), max(1, len(rows) // POINTS))
        scans.append([(rows[i], words[i][0]) for i in chosen])
    return scans


def write_kitti(source, scans, folder):
    for part in ("velodyne", "labels"):
        (folder / part).mkdir(parents=True)
    for i, scan in enumerate(scans):
        points = b"".join(struct.pack("<4f", *row) for row, _ in scan)
        words = b"".join(struct.pack("<I", word) for _, word in scan)
        (folder / "velodyne" / f"{i:06}.bin").write_bytes(points)
        (folder / "labels" / f"{i:06}.label").write_bytes(words)
    for name in ("poses.txt", "calib.txt", "times.txt", "sequence.json"):
        shutil.copy(source / name, folder / name)


def pcd(scan, data, viewpoint="0 0 0 1 0 0 0", labels=False):
    rows = [(row[0], row[1], row[2], float(word & 0xFFFF) if labels else row[3]) for row, word in scan]
    head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
            f"WIDTH {len(rows)}\nHEIGHT 1\nVIEWPOINT {viewpoint}\nPOINTS {len(rows)}\nDATA {data}\n").encode()
    if data == "ascii":
        return head + "".join(f"{a:.4f} {b:.4f} {c:.4f} {d:g}\n" for a, b, c, d in rows).encode()
    if data == "binary":
        return head + b"".join(struct.pack("<4f", *row) for row in rows)
    columns = b"".join(struct.pack("<f", row[k]) for k in range(4) for row in rows)
    packed = b"".join(bytes([len(piece) - 1]) + piece  # LZF of literal runs only.
                      for piece in (columns[i:i + 32] for i in range(0, len(columns), 32)))
    return head + struct.pack("<2I", len(packed), len(columns)) + packed


def ply(scan, binary):
    form = "binary_little_endian" if binary else "ascii"
    head = (f"ply\nformat {form} 1.0\nelement vertex {len(scan)}\nproperty float x\nproperty float y\n"
            "property float z\nproperty float intensity\nend_header\n").encode()
    if binary:
        return head + b"".join(struct.pack("<4f", *row) for row, _ in scan)
    return head + "".join("{:.4f} {:.4f} {:.4f} {:.3f}\n".format(*row) for row, _ in scan).encode()


def write_files(scans, folder, suffix, content):
    (folder / "labels").mkdir(parents=True)
    for i, scan in enumerate(scans):
        (folder / f"{i:06}{suffix}").write_bytes(content(scan))
        words = b"".join(struct.pack("<I", word) for _, word in scan)
        (folder / "labels" / f"{i:06}.label").write_bytes(words)
    rows = "".join(f"{0.1 * i:.1f} {0.5 * i:.2f} 0 0 0 0 0 1\n" for i in range(len(scans)))
    (folder / "poses.txt").write_text(rows)


def make_bases(program, folder):
    """The good sequences: their folders, and what `raymoval` is given."""
    whole = folder / "whole"
    subprocess.run([program, "simulate", f"town:scans={SCANS},sensor=vlp16", "-o", whole, "--quiet"], check=True)
    scans = read_scans(whole)
    write_kitti(whole, scans, folder / "kitti")
    write_kitti(whole, scans, folder / "root" / "sequences" / "05")
    (folder / "dynamicmap" / "pcd").mkdir(parents=True)
    for i, scan in enumerate(scans):
        moved = [((row[0] + 0.5 * i, *row[1:]), word) for row, word in scan]
        text = pcd(moved, "ascii" if i % 2 else "binary", f"{0.5 * i} 0 0 1 0 0 0", labels=True)
        (folder / "dynamicmap" / "pcd" / f"{i:06}.pcd").write_bytes(text)
    rule = {"labels": {"moving": list(range(252, 260)), "ignored": [0, 1]}}
    (folder / "dynamicmap" / "sequence.json").write_text(json.dumps(rule))
    write_files(scans, folder / "pcd_ascii", ".pcd", lambda scan: pcd(scan, "ascii"))
    write_files(scans, folder / "pcd_lzf", ".pcd", lambda scan: pcd(scan, "binary_compressed"))
    write_files(scans, folder / "ply", ".ply", lambda scan: ply(scan, True))
    write_files(scans, folder / "ply_ascii", ".ply", lambda scan: ply(scan, False))
    write_files(scans, folder / "bin", ".bin", lambda scan: b"".join(struct.pack("<4f", *row) for row, _ in scan))
    shutil.rmtree(whole)
    return {name: ("root:05" if name == "root" else name) for name in sorted(p.name for p in folder.iterdir())}


# Damage.


def bytes_damage(rng, path):
    data = bytearray(path.read_bytes())
    at = rng.randrange(len(data)) if data else 0
    size = min(rng.choice((1, 1, 2, 4, 16, 100)), len(data) - at)
    kind = rng.randrange(8)
    if kind == 0:
        data[at:at + size] = rng.randbytes(size)
    elif kind == 1:
        del data[at:at + size]
    elif kind == 2:
        data[at:at] = rng.randbytes(size)
    elif kind == 3:
        del data[at:]
    elif kind == 4:
        data[at:at + size] = bytes([rng.choice((0, 255, 10, 32, 48, 45))]) * size
    elif kind == 5:
        data[at:at] = data[at:at + size] * rng.choice((1, 10, 1000))
    elif kind == 6:
        data = bytearray(rng.choice((b"", b"\0", b"\n", b"\xef\xbb\xbf", b"[" * 5000, b"{}", b"null")))
    elif data:
        data[at] ^= 1 << rng.randrange(8)
    path.write_bytes(data)


def number_damage(rng, path):
    """Replaces numbers of a text, or points and labels of a binary file."""
    data = bytearray(path.read_bytes())
    for _ in range(rng.choice((1, 1, 1, 3, 20))):
        if path.suffix in (".bin", ".label", ".ply", ".pcd") and rng.random() < 0.7 and len(data) >= 4:
            at = rng.randrange(len(data) // 4) * 4 if path.suffix in (".bin", ".label") else rng.randrange(len(data) - 3)
            value = rng.choice(FLOATS) if rng.random() < 0.8 else struct.unpack("<f", rng.randbytes(4))[0]
            data[at:at + 4] = struct.pack("<f", value) if path.suffix != ".label" else rng.randbytes(4)
            continue
        text = data.decode("latin-1")
        lines = text.split("\n")
        row = rng.randrange(len(lines))
        words = lines[row].split(" ")
        words[rng.randrange(len(words))] = rng.choice(NUMBERS)
        lines[row] = " ".join(words)
        data = bytearray("\n".join(lines).encode("utf-8", "replace"))
    path.write_bytes(data)


def line_damage(rng, path):
    lines = path.read_bytes().split(b"\n")
    at, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(4)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, lines[other])
    elif kind == 2:
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at] = lines[at][:rng.randrange(len(lines[at]) + 1)]
    path.write_bytes(b"\n".join(lines))


def name_damage(rng, path):
    kind = rng.randrange(8)
    if kind == 0:
        path.rename(path.with_name(rng.choice(("-1.bin", "x\x1b[31m.bin", "000001.pcd", "99999999999999999999.bin",
                                               "\u202e.ply", "=1.bin", "poses.txt", ".hidden", "a b.label"))))
        return
    if kind == 1:
        shutil.copy(path, path.with_name(f"{rng.randrange(12):0{rng.choice((1, 6))}}{path.suffix}"))
        return
    path.unlink()
    if kind == 2:
        path.mkdir()
    elif kind == 3:
        os.mkfifo(path)
    elif kind == 4:
        path.symlink_to(rng.choice(("/dev/zero", path.name, "/nowhere", "..", "/proc/self/mem", "/dev/stdin")))
    elif kind == 5:
        with open(path, "wb") as file:
            file.truncate(rng.choice((1, 16, 4096, 16 * 100000)))


def settings_damage(rng, folder):
    def value(depth=0):
        kind = rng.randrange(7 if depth < 3 else 5)
        if kind == 0:
            return rng.choice(TEXTS)
        if kind == 1:
            return rng.choice((0, -1, 1, 1e308, 0.1, 2 ** 63, 1e-300, 70000))
        if kind == 2:
            return rng.choice((True, False, None))
        if kind < 5:
            return {"min": rng.choice((0, 2, -1, 1e300)), "max": rng.choice((30, 1, 1e308, 0))}
        if kind == 5:
            return [value(depth + 1) for _ in range(rng.randrange(4))]
        return {rng.choice(("moving", "ignored", "min", "max", "name")): value(depth + 1) for _ in range(2)}

    settings = {rng.choice(KEYS): value() for _ in range(rng.choice((1, 1, 2, 4)))}
    (folder / "sequence.json").write_text(json.dumps(settings))


def damage(rng, folder):
    """Damages a sequence once, or a few times."""
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        files = sorted(path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
        if not files:
            return
        texts = [path for path in files if path.suffix in (".txt", ".json")]
        path = rng.choice(texts) if texts and rng.random() < 0.4 else rng.choice(files)
        kind = rng.random()
        if kind < 0.3:
            bytes_damage(rng, path)
        elif kind < 0.7:
            number_damage(rng, path)
        elif kind < 0.8:
            line_damage(rng, path)
        elif kind < 0.9:
            name_damage(rng, path)
        else:
            settings_damage(rng, path.parent if path.parent.name not in ("velodyne", "labels", "pcd")
                            else path.parent.parent)


# The program.


def limits():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
    if not SANITIZERS:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def no_constant(text):
    raise ValueError(f"{text} in JSON")


def finite(value):
    if isinstance(value, dict):
        return all(finite(item) for item in value.values())
    if isinstance(value, list):
        return all(finite(item) for item in value)
    return not isinstance(value, float) or math.isfinite(value)


class Outcome:
    def __init__(self, program, work, arguments):
        self.command = [str(argument) for argument in arguments]
        self.fault = ""
        try:
            done = subprocess.run([program, *self.command], cwd=work, stdin=subprocess.DEVNULL,
                                  capture_output=True, timeout=SECONDS, preexec_fn=limits)
        except subprocess.TimeoutExpired:
            self.code, self.err, self.out = None, "", ""
            self.fault = f"does not end in {SECONDS} s"
            return
        self.code = done.returncode
        self.out, self.err = done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")
        if self.code not in (0, 1, 2):
            self.fault = f"exit code {self.code}"
        elif self.code == 2 and "raymoval: " not in self.err:
            self.fault = "exit code 2 without a message"
        elif self.code == 1 and not (self.out or self.err):
            self.fault = "exit code 1 without a message"
        elif "Sanitizer" in self.err or "runtime error" in self.err or "internal error" in self.err:
            self.fault = "a report of a fault"
        elif any(ord(c) < 32 and c not in "\n\t" or c in "\x7f\u202e" for c in self.out + self.err):
            self.fault = "control characters"


def json_fault(path):
    """What is wrong with a file of results."""
    try:
        return "" if finite(json.loads(path.read_text(), parse_constant=no_constant)) else "a number that is not finite"
    except (OSError, ValueError) as error:
        return str(error)


def try_sequence(rng, program, work, name):
    """Runs the commands on a sequence. Returns faults, and whether a cell fails on it unseen."""
    method = rng.choice(METHODS)
    shutil.rmtree(work / "out", ignore_errors=True)
    (work / "out").mkdir()
    found = Outcome(program, work, ["inspect", name, "--json", "--quiet", "--threads", "1"])
    process = [] if rng.random() < 0.2 else ["--in-process"]
    run = Outcome(program, work, ["run", "--sequence", name, "--method", method, "--out", "out/run", "--quiet",
                                  "--threads", rng.choice("12"), "--keep-removals", *process])
    clean = Outcome(program, work, ["clean", name, "-o", "out/map.pcd", "--quiet", "--threads", "1", "--method", method,
                                    *(["--force"] if rng.random() < 0.7 else []), *process])
    removals = next(iter(sorted((work / "out").glob("run/cells/*/*/removals"))), work / "out")
    score = Outcome(program, work, ["score", name, "--predictions", removals, "--json", "out/score.json", "--quiet",
                                    "--threads", "1"])
    outcomes = [found, run, clean, score]
    if run.code == 0:
        run.fault = run.fault or json_fault(work / "out/run/results.json")
    if score.code == 0:
        score.fault = score.fault or json_fault(work / "out/score.json")
    if clean.code == 0 and not (work / "out/map.pcd").exists():
        clean.fault = clean.fault or "exit code 0 without a map"
    if clean.code not in (0, None) and list((work / "out").glob("map.pcd*")):
        clean.fault = clean.fault or "a map in spite of an error"
    unseen = ""
    if found.code == 0 and run.code in (1, 2):
        unseen = (run.err.strip().splitlines() or ["?"])[0][:200]
    return outcomes, unseen


def main():
    program, count, seed, kept = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), Path(sys.argv[4])
    codes, faults, unseen = {}, 0, []
    described = subprocess.run([program, "describe", "octomap:ground-noise"], capture_output=True, text=True).stdout
    if "PCL, which this build lacks" in described:
        METHODS.remove("octomap:ground-noise")
    with tempfile.TemporaryDirectory(prefix="raymoval_fuzz_") as place:
        place = Path(place)
        os.environ["RAYMOVAL_CACHE"] = str(place / "cache")
        (place / "bases").mkdir()
        bases = make_bases(program, place / "bases")
        for base, name in bases.items():  # A damaged sequence says little where a good one fails.
            work = place / "good"
            shutil.copytree(place / "bases" / base, work / base)
            for outcome in try_sequence(random.Random(seed), program, work, name)[0]:
                if outcome.fault or outcome.code == 2 and outcome.command[0] != "score":
                    sys.exit(f"sequences.py: a good sequence fails ({base}): {outcome.command} {outcome.code} "
                             f"{outcome.fault} {outcome.err}")
            shutil.rmtree(work)
        for number in range(count):
            rng = random.Random(f"{seed}-{number}")
            base = rng.choice(list(bases))
            work = place / "work"
            shutil.copytree(place / "bases" / base, work / base)
            damage(rng, work / base)
            outcomes, missed = try_sequence(rng, program, work, bases[base])
            for outcome in outcomes:
                codes[outcome.command[0], outcome.code] = codes.get((outcome.command[0], outcome.code), 0) + 1
            bad = [outcome for outcome in outcomes if outcome.fault]
            if missed:
                unseen.append((number, missed))
            if bad or missed:
                folder = kept / f"{seed}-{number}"
                shutil.rmtree(folder, ignore_errors=True)
                shutil.copytree(work, folder, symlinks=True, copy_function=copy_plain)
            for outcome in bad:
                faults += 1
                print(f"{seed}-{number}: {outcome.fault}: raymoval {' '.join(outcome.command)}\n  {outcome.err[:500]}",
                      flush=True)
            shutil.rmtree(work)
    for number, line in unseen:
        print(f"{seed}-{number}: inspect finds nothing, and run says: {line}")
    told = ", ".join(f"{command} {code}: {times}" for (command, code), times in
                     sorted(codes.items(), key=lambda item: (item[0][0], str(item[0][1]))))
    print(f"{count} sequences, seed {seed}: {faults} faults, {len(unseen)} unseen by inspect; exit codes: {told}")
    return 1 if faults or unseen else 0


def copy_plain(source, target):
    """Copies files, and leaves out pipes and devices."""
    if os.path.isfile(source):
        shutil.copy(source, target)


if __name__ == "__main__":
    sys.exit(main())
