# SPDX-License-Identifier: MIT
"""Records what the methods of a commit score: the work of scripts/record.sh, which says more."""
import argparse
import itertools
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SUITES = ["benchmark/suites/quick.json", "benchmark/suites/simulated-quick.json"]
TIMED_SCENE = "street"
FULL_BYTES = 900_000  # A machine's lines go on in another file then; files of a repository are small.
REFERENCE = "reference"  # Stands for the machine of lines that were taken from results/reference.


class Failure(Exception):
    """What ends the recorder, with its exit code."""

    def __init__(self, message, code=2):
        super().__init__(message)
        self.code = code


def output_of(command, **options):
    """What a command prints. A command that fails ends the recorder."""
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise Failure(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr.strip()}")
    return done.stdout


def git(*arguments):
    return output_of(["git", "-C", ROOT, *arguments], env={**os.environ, "TZ": "UTC"}).rstrip()


def commit_of(revision):
    try:
        git("rev-parse", "--git-dir")
    except Failure:
        raise Failure("a commit is recorded, so a git repository is needed") from None
    try:
        return git("rev-parse", "--verify", "--quiet", revision + "^{commit}")
    except Failure:
        raise Failure(f"{revision}: this repository has no such commit (git log lists them; after "
                      "git clone --depth, git fetch --unshallow brings the older ones)") from None


def date_of(commit):
    return git("show", "-s", "--date=format-local:%Y-%m-%dT%H:%M:%SZ", "--format=%cd", commit)


def check_clean(out):
    """Only a clean tree is the commit that it says it is. The history itself does not count."""
    changes = [line for line in git("status", "--porcelain").splitlines()
               if not os.path.join(ROOT, line[3:]).startswith(os.path.abspath(out))]
    if changes:
        raise Failure("the tree is not clean, so it is no commit that could be recorded:\n  "
                      + "\n  ".join(changes[:5])
                      + "\nCommit the changes or put them aside (git stash), and record again.")


def build():
    build_folder = os.path.join(ROOT, "build/release")
    if not os.path.exists(os.path.join(build_folder, "CMakeCache.txt")):
        output_of(["cmake", "--preset", "release"], cwd=ROOT)
    print("record.sh: building", flush=True)
    output_of(["cmake", "--build", build_folder, "--target", "raymoval_program"])
    return os.path.join(build_folder, "raymoval")


def yardstick_program():
    build_folder = os.path.join(ROOT, "build/release")
    if not os.path.exists(os.path.join(build_folder, "CMakeCache.txt")):
        output_of(["cmake", "--preset", "release"], cwd=ROOT)
    output_of(["cmake", "--build", build_folder, "--target", "raymoval_yardstick"])
    return os.path.join(build_folder, "raymoval_yardstick")


def read_suite(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return json.loads(re.sub(r"^\s*//.*$", "", file.read(), flags=re.M))


def knows(program, name):
    return subprocess.run([program, "describe", name], capture_output=True).returncode == 0


def wanted(program):
    """Scenes and methods of the suites; methods that the program does not have are left out."""
    suites = [read_suite(path) for path in SUITES]
    sequences = [sequence for suite in suites for sequence in suite["sequences"]]
    methods = [name for name in suites[0]["methods"] if knows(program, name)]
    if not methods:
        raise Failure(f"{program}: knows none of the methods of {SUITES[0]}")
    return sequences, methods, suites[0]["protocols"]


def run(program, suite, folder, *options):
    """results.json and run.json of a run of `suite`. A cell that fails is a line of its own."""
    path = folder + ".json"
    with open(path, "w", encoding="utf-8") as file:
        json.dump(suite, file)
    done = subprocess.run([program, "run", path, "--out", folder, "--quiet", *options],
                          capture_output=True, text=True)
    results = os.path.join(folder, "results.json")
    if done.returncode not in (0, 1) or not os.path.exists(results):
        raise Failure(f"{program} run: exit code {done.returncode}\n{done.stderr.strip()}")
    with open(results, encoding="utf-8") as file, \
            open(os.path.join(folder, "run.json"), encoding="utf-8") as record:
        return json.load(file), json.load(record)


def found_text(record, key):
    """The first text under `key`, wherever it stands: old programs have other places for it."""
    if isinstance(record, dict):
        if isinstance(record.get(key), str):
            return record[key]
        record = list(record.values())
    if isinstance(record, list):
        for item in record:
            text = found_text(item, key)
            if text:
                return text
    return ""


def machine_name(record):
    processor = found_text(record.get("machine", {}), "processor") or "unknown processor"
    return re.sub(r"[^a-z0-9]+", "-", f"{processor} {os.cpu_count()} threads".lower()).strip("-")


def check_commit(record, commit, program):
    """What the program says of itself has to be what is recorded."""
    built, tree = found_text(record.get("build", {}), "commit"), found_text(
        record.get("build", {}), "tree")
    if built not in ("", "unknown") and built != commit:
        raise Failure(f"{program}: was built from commit {built[:12]}, not from {commit[:12]}")
    if tree == "changed":
        raise Failure(f"{program}: was built from a tree that differs from its commit")


def measured_speed(program, methods, rounds, scratch):
    """By method: times of the method on street as multiples of the yardstick's."""
    if rounds == 0:
        return {}
    yardstick = yardstick_program()
    times = {}
    name = ""
    for number in range(rounds):
        print(f"record.sh: times, round {number + 1} of {rounds}", flush=True)
        for method in methods:
            name, milliseconds = output_of([yardstick]).rstrip("\n").split("\t")
            suite = {"sequences": [TIMED_SCENE], "methods": [method], "protocols": ["erasor"],
                     "controls": False, "threads": 1}
            folder = os.path.join(scratch, f"time-{number}-{method.replace(':', '-')}")
            results, _ = run(program, suite, folder)
            cell = results["cells"][0]
            if cell["status"] == "ok":
                taken = 1e3 * cell["measured"]["seconds_total"]
                times.setdefault(method, []).append((taken, taken / float(milliseconds)))
    return {method: {"yardstick": name, "rounds": len(taken),
                     "milliseconds": round(statistics.median(t for t, _ in taken), 2),
                     "median": round(statistics.median(r for _, r in taken), 4),
                     "min": round(min(r for _, r in taken), 4),
                     "max": round(max(r for _, r in taken), 4)}
            for method, taken in times.items()}


def line_of(cell, head, speed):
    scores = [{"protocol": score["name"], "version": score.get("version", ""),
               "counts": score["counts"], "rates": score["rates"]}
              for score in cell.get("protocols") or []]
    return {"schema_version": 1, **head, "sequence": cell["sequence"],
            "fingerprint": (cell.get("data") or {}).get("fingerprint", ""),
            "method": cell["name"], "method_version": cell["method"]["version"],
            "status": cell["status"], "masks": (cell.get("masks") or {}).get("digest", ""),
            "protocols": scores,
            "speed": speed.get(cell["name"]) if cell["sequence"] == TIMED_SCENE else None}


def key_of(line):
    return line["commit"], line["sequence"], line["method"]


def files_of(folder, machine):
    """The files of a machine in order; the last one is the first that is not full."""
    for number in itertools.count(1):
        path = os.path.join(folder, machine + (f".{number}" if number > 1 else "") + ".jsonl")
        yield path
        if not os.path.exists(path) or os.path.getsize(path) < FULL_BYTES:
            return


def known_lines(paths):
    known = {}
    for path in filter(os.path.exists, paths):
        with open(path, encoding="utf-8") as file:
            known.update({key_of(line): line for line in map(json.loads, filter(str.strip, file))})
    return known


def append(folder, machine, lines):
    """Adds what is not there yet, in one write. Says how many lines that were."""
    os.makedirs(folder, exist_ok=True)
    paths = list(files_of(folder, machine))
    known = known_lines(paths)
    for line in lines:
        before = known.get(key_of(line))
        if before is not None and (before["protocols"], before["masks"]) != (
                line["protocols"], line["masks"]):
            raise Failure(f"{line['sequence']} / {line['method']}: commit {line['commit'][:12]} is "
                          "recorded with another answer; the same commit must give the same", 1)
    new = [line for line in lines if key_of(line) not in known]
    with open(paths[-1], "a", encoding="utf-8") as file:
        file.write("".join(json.dumps(line, separators=(",", ":"), ensure_ascii=False) + "\n"
                           for line in new))
        file.flush()
        os.fsync(file.fileno())
    print(f"record.sh: {len(new)} lines added to {os.path.relpath(paths[-1])}, "
          f"{len(lines) - len(new)} were there already")


def reference_lines(revision):
    """What results/reference/street was at a commit, whose own program made it."""
    commit = commit_of(revision)
    path = f"results/reference/{TIMED_SCENE}/results.json"
    try:
        results = json.loads(git("show", f"{commit}:{path}"))
    except (Failure, ValueError) as error:
        raise Failure(f"--reference {revision}: it has no {path} ({error})") from None
    found = re.search(r"project\(raymoval VERSION (\S+)", git("show", f"{commit}:CMakeLists.txt"))
    head = {"commit": commit, "date": date_of(commit), "version": found.group(1),
            "machine": REFERENCE}
    return [line_of(cell, head, {}) for cell in results["cells"]
            if not cell["method"].get("control")]


def record_references(given):
    for revision in given.reference:
        append(given.out, REFERENCE, reference_lines(revision))


def arguments():
    parser = argparse.ArgumentParser(prog="record.sh", add_help=False)
    parser.add_argument("--program")
    parser.add_argument("--commit")
    parser.add_argument("--reference", nargs="+")
    parser.add_argument("--machine")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--out", default=os.path.join(ROOT, "results/history"))
    given = parser.parse_args()
    if given.commit and not given.program:
        raise Failure("--commit goes with --program: what is built here is HEAD")
    if given.program and not given.commit:
        raise Failure("--program goes with --commit: expected the commit that it was built from")
    if given.reference and (given.program or given.machine):
        raise Failure("--reference goes without --program and --machine: nothing is run")
    if given.rounds < 0:
        raise Failure("--rounds: expected 0 or more")
    if given.machine and not re.fullmatch(r"[a-z0-9][a-z0-9.-]*", given.machine):
        raise Failure(f"--machine {given.machine}: expected lower-case letters, digits, '-', '.'")
    return given


def record(given):
    if given.program:
        program = os.path.abspath(given.program)
        if not os.access(program, os.X_OK):
            raise Failure(f"--program {given.program}: no program; expected build/release/raymoval")
    else:
        check_clean(given.out)
        program = build()
    commit = commit_of(given.commit or "HEAD")
    sequences, methods, protocols = wanted(program)
    with tempfile.TemporaryDirectory(prefix="raymoval-record-") as scratch:
        print(f"record.sh: commit {commit[:12]}, {len(methods)} methods on {len(sequences)} scenes",
              flush=True)
        results, run_record = run(program, {
            "name": "history", "sequences": sequences, "methods": methods,
            "protocols": protocols, "controls": False}, os.path.join(scratch, "run"))
        check_commit(run_record, commit, program)
        machine = given.machine or machine_name(run_record)
        speed = measured_speed(program, methods, given.rounds, scratch)
    head = {"commit": commit, "date": date_of(commit),
            "version": output_of([program, "--version"]).split()[-1], "machine": machine}
    append(given.out, machine, [line_of(cell, head, speed) for cell in results["cells"]])


if __name__ == "__main__":
    try:
        chosen = arguments()
        record_references(chosen) if chosen.reference else record(chosen)
    except Failure as failure:
        print(f"record.sh: {failure}", file=sys.stderr)
        sys.exit(failure.code)
