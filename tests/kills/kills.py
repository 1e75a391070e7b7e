#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Kills small commands of raymoval at random moments and looks at what is left.

Usage: kills.py PROGRAM COUNT SEED

Each of COUNT times a command is started (`run` from the start, resumed, and with two jobs, `clean` with and without
outputs to replace, `simulate`, and `run` on a scene that is not in the cache yet), and after a
random share of the time that it takes a signal is sent (INT, TERM, HUP or KILL) to the program, to
one of its descendants, or to all of them. SEED decides all of this; what the program is just doing
then also depends on the machine. The method among others is an external program that starts a
process without parent, session and environment. Afterwards
- the exit code is one that the signal may lead to,
- no process that was started is left,
- what has a final name is whole: as it was before, or as an undisturbed command makes it,
- the same command, started again, ends with the files of an undisturbed one, and leaves nothing
  unfinished: in the folder for temporary files, in the cache, beside its outputs.
Prints what does not hold; the exit code is then 1.
"""

import collections
import filecmp
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

CHECKS = pathlib.Path(__file__).resolve().parent.parent / "cli" / "checks.sh"
SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL]
PATIENCE_S = 60.0

MANIFEST = {
    "name": "keeper", "sentence": "Keeps all.", "source": "none", "version": "1", "online": False,
    "command": ["sh", "{here}/keep.sh"], "files": ["keep.sh"],
}
# Keeps all points; meanwhile a daemon and a child sleep for a time that identifies them.
KEEP = """
(env -i setsid sh -c 'sleep NAP & wait' >/dev/null 2>&1 &)
sleep NAP &
for scan in velodyne/*.bin; do
  perl -e 'print pack("V", 9) x ((-s $ARGV[0]) / 16)' "$scan" \
    >predictions/$(basename "$scan" .bin).label
done
exit 0
"""


class Place:
    """A folder for everything, and the processes that were started from it."""

    def __init__(self, program):
        self.program = program
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="raymoval-kills-"))
        self.temporary, self.cache = self.root / "temporary", self.root / "cache"
        self.temporary.mkdir()
        self.nap = f"5000.{os.getpid()}"
        self.mark = f"RAYMOVAL_KILLS={os.getpid()}"
        name, value = self.mark.split("=")
        self.environment = dict(os.environ, TMPDIR=str(self.temporary),
                                RAYMOVAL_CACHE=str(self.cache), **{name: value})
        method = self.root / "method"
        method.mkdir()
        (method / "manifest.json").write_text(json.dumps(MANIFEST))
        (method / "keep.sh").write_text(KEEP.replace("NAP", self.nap))
        self.method = f"external:{method}/manifest.json"

    def start(self, arguments, folder):
        return subprocess.Popen([self.program, *arguments], cwd=folder, env=self.environment,
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True,
                                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def left_processes(self):
        """Processes that were started here, whatever became of their parents and environment."""
        left = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                line = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode().strip()
                marked = self.mark.encode() in (entry / "environ").read_bytes().split(b"\0")
            except OSError:
                continue
            if line and (marked or line == f"sleep {self.nap}"):
                left.append(int(entry.name))
        return left

    def unfinished(self):
        """Files and folders that no finished command leaves."""
        names = [p for p in self.root.rglob("*") if p.name.endswith((".part", ".lock", ".before"))]
        return names + list(self.temporary.iterdir())


def parents():
    """The parent of each process."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                found[int(entry.name)] = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                pass
    return found


def descendants(process):
    known = parents()
    found = [process]
    for parent in found:
        found += [child for child, its_parent in known.items() if its_parent == parent]
    return found[1:]


def send(process, number):
    try:
        os.kill(process, number)
    except ProcessLookupError:
        pass


def send_to_all(process, number, order):
    """To a program and all that it has started; they cannot start more meanwhile."""
    everybody = []
    while True:
        new = [p for p in [process, *descendants(process)] if p not in everybody]
        if not new:
            break
        for one in new:
            send(one, signal.SIGSTOP)
        everybody += new
    order.shuffle(everybody)
    for one in everybody:
        send(one, number)
    for one in everybody:
        send(one, signal.SIGCONT)


def same_file(a, b):
    return a.is_file() and b.is_file() and filecmp.cmp(a, b, shallow=False)


def same_folder(a, b):
    names = [sorted(str(p.relative_to(x)) for p in x.rglob("*")) for x in (a, b)]
    return names[0] == names[1] and all(
        same_file(a / n, b / n) for n in names[0] if (a / n).is_file())


def same(a, b):
    return same_folder(a, b) if a.is_dir() and b.is_dir() else same_file(a, b)


class Job:
    """A command, the folder that it starts with, and what it makes there."""

    def __init__(self, place, name, arguments, made, before=None, keeps_cache=True):
        self.place, self.name, self.arguments, self.made = place, name, arguments, made
        self.keeps_cache = keeps_cache
        self.before = place.root / f"{name}-before"
        self.before.mkdir()
        if before is not None:
            before(self.before)
        self.reference = place.root / f"{name}-reference"
        self.prepare(self.reference)
        started = time.monotonic()
        self.finish(self.reference)
        self.seconds = time.monotonic() - started

    def prepare(self, folder):
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.before, folder)
        if not self.keeps_cache:
            shutil.rmtree(self.place.cache, ignore_errors=True)

    def finish(self, folder):
        if self.name == "simulate" and same(folder / "drive", self.reference / "drive"):
            return  # It refuses to overwrite a sequence.
        process = self.place.start(self.arguments, folder)
        _, said = process.communicate(timeout=10 * PATIENCE_S)
        if process.returncode != 0:
            raise RuntimeError(f"{self.name} ended with {process.returncode}: {said}")

    def half_written(self, folder):
        """What has a final name and is neither as before nor as an undisturbed command makes it."""
        if self.made == ["out"]:  # Checked by going on with it; here only that JSON is whole.
            files = [p for p in folder.rglob("*.json") if not p.name.startswith(".")]
            return [p for p in files if not is_json(p)]
        return [folder / name for name in self.made if (folder / name).exists()
                and not same(folder / name, self.reference / name)
                and not same(folder / name, self.before / name)]

    def ends_as_reference(self, folder):
        if self.made != ["out"]:
            return all(same(folder / name, self.reference / name) for name in self.made)
        script = 'source "$0"; same_but_times "$1" "$2"'
        return subprocess.run(["bash", "-c", script, CHECKS, self.reference / "out", folder / "out"],
                              stdout=subprocess.DEVNULL, check=False).returncode == 0


def is_json(path):
    try:
        json.loads(path.read_text())
        return True
    except ValueError:
        return False


def jobs_in(place):
    run = ["run", "--sequence", "street", "--frames", "0:2", "--method", "raymoval:online",
           "--method", place.method, "--keep-removals", "--quiet", "--threads", "1", "--out", "out"]
    clean = ["clean", "street", "--frames", "0:2", "--quiet", "--threads", "1", "--overwrite",
             "-o", "map.pcd", "--dynamic", "removed.ply", "--labels", "labels"]
    cleaned = ["map.pcd", "removed.ply", "labels"]

    def begun(folder):
        place.start([*run, "--only", "*/noop*", "--only", "*/raymoval*"], folder).communicate()

    def other(folder):
        place.start([*clean, "--method", "noop", "--voxel", "1"], folder).communicate()

    return [
        Job(place, "run", run, ["out"]),
        Job(place, "resumed", run, ["out"], begun),
        Job(place, "beside", [*run, "--jobs", "2"], ["out"]),
        Job(place, "clean", [*clean, "--method", place.method], cleaned),
        Job(place, "replace", [*clean, "--method", "raymoval:online"], cleaned, other),
        Job(place, "simulate", ["simulate", "suburb", "--scans", "2", "--sensor", "vlp16", "--quiet",
                                "--threads", "1", "-o", "drive"], ["drive"]),
        Job(place, "cache", ["run", "--sequence", "suburb:scans=1", "--method", "octomap", "--quiet",
                             "--threads", "1", "--out", "out"], ["out"], keeps_cache=False),
    ]


def wait_for_victims(process, victim):
    """A descendant if one is asked for and there is one before the program ends."""
    while victim == "child" and process.poll() is None:
        found = descendants(process.pid)
        if found:
            return found
    return [process.pid]


def allowed_codes(victim, number):
    """Done before the signal came; ended by it; a method or program that was ended."""
    return [0, 1, 2] if victim == "child" else [0, 128 + number]


def kill_once(place, job, order, tally):
    """@return what does not hold"""
    victim, number = order.choice(["parent", "child", "tree"]), order.choice(SIGNALS)
    delay = order.uniform(0.0, 1.02 * job.seconds)
    folder = place.root / "killed"
    job.prepare(folder)
    process = place.start(job.arguments, folder)
    try:
        process.wait(timeout=delay)
    except subprocess.TimeoutExpired:
        pass
    victims = wait_for_victims(process, victim)
    if victims == [process.pid] and victim == "child":
        victim = "parent"  # `simulate` has no descendants.
    hit = process.poll() is None
    if hit and victim == "tree":
        send_to_all(process.pid, number, order)
    elif hit:
        send(order.choice(victims), number)
    tally[f"{victim} {number.name}" if hit else "too late"] += 1
    try:
        _, said = process.communicate(timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        return [f"hangs after {number.name} to {victim}"]
    problems = []
    code = process.returncode if process.returncode >= 0 else 128 - process.returncode
    if code not in allowed_codes(victim, number):
        problems.append(f"exit code {code}: {said.strip()}")
    for _ in range(500):
        if not place.left_processes():
            break
        time.sleep(0.02)
    for left in place.left_processes():
        problems.append(f"process {left} is left")
        send(left, signal.SIGKILL)
    problems += [f"{path} is half written" for path in job.half_written(folder)]
    tally["left something unfinished"] += 1 if place.unfinished() else 0
    try:
        job.finish(folder)
    except RuntimeError as error:
        return [*problems, f"then {error}"]
    if not job.ends_as_reference(folder):
        problems.append("the next command does not end with the files of an undisturbed one")
    problems += [f"{path} is still there after the next command" for path in place.unfinished()]
    where = f"{job.name}, {number.name} to {victim} after {delay:.3f} s: "
    return [where + problem for problem in problems]


def stop(*_):
    raise KeyboardInterrupt


def main():
    signal.signal(signal.SIGTERM, stop)
    program, count, seed = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    place = Place(program)
    tally = collections.Counter()
    problems = []
    jobs = jobs_in(place)
    done = 0
    try:
        for number in range(count):
            order = random.Random(f"{seed} {number}")
            job = jobs[number % len(jobs)]
            for problem in kill_once(place, job, order, tally):
                problems.append(problem)
                print(f"FAILED: kill {number}: {problem}", flush=True)
            tally[job.name] += 1
            done += 1
    except KeyboardInterrupt:
        print("interrupted")
    shutil.rmtree(place.root, ignore_errors=True)
    print(", ".join(f"{name}: {number}" for name, number in sorted(tally.items())))
    print(f"{done} kills with seed {seed}: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
