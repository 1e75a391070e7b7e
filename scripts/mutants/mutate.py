# SPDX-License-Identifier: MIT
"""See scripts/mutate.sh."""

import argparse
import collections
import json
import os
import pathlib
import random
import re
import subprocess
import sys

import rooms
import running

ROOT = pathlib.Path(__file__).resolve().parents[2]
EQUIVALENT = ROOT / "tests" / "mutants" / "equivalent.md"


def arguments():
    parser = argparse.ArgumentParser(prog="mutate.sh", allow_abbrev=False)
    parser.add_argument("--room", choices=list(rooms.ROOMS), default="eval")
    parser.add_argument("--file", action="append", default=[])
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--tests", default="")
    parser.add_argument("--survivors", action="store_true")
    parser.add_argument("--list", action="store_true")
    return parser.parse_args()


def numbered(mutants):
    """Keys of mutants: file, function, change; a change that stands there again has #2, #3 ..."""
    seen, keys = collections.Counter(), {}
    for mutant in mutants:
        seen[mutant.key()] += 1
        count = seen[mutant.key()]
        change = mutant.change + (f" #{count}" if count > 1 else "")
        keys[mutant.number] = (mutant.file, mutant.function, change)
    return keys


def explained():
    """Keys that tests/mutants/equivalent.md explains."""
    keys, file = set(), ""
    if not EQUIVALENT.exists():
        return keys
    for line in EQUIVALENT.read_text(encoding="utf-8").splitlines():
        if found := re.fullmatch(r"## `?([^`]+)`?", line):
            file = found[1]
        elif found := re.match(r"- `(\w[^`]*)`: ``(.+?)``", line):
            keys.add((file, found[1], found[2]))
    return keys


def chosen_files(options):
    room = rooms.ROOMS[options.room]
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True,
                             text=True).stdout.splitlines()
    names = rooms.files_of(room, tracked)
    if options.file:
        unknown = [f for f in options.file if f not in names]
        if unknown:
            sys.exit(f"mutate.sh: {unknown[0]} is no file of room {options.room}; these are:\n  " +
                     "\n  ".join(names))
        names = options.file
    return room, names


def built(room, names, options):
    """The mutants and the programs with the cases that reach them."""
    import building  # Needs clang's module, which a look at the options does not.
    release = building.ReleaseBuild(ROOT, room.programs)
    build = building.MutatedBuild(release, ROOT / "build" / "mutants" / options.room, options.jobs)
    build.plant(names)
    mutants = [m for p in build.planted.values() for m in p.mutants]
    if options.list:
        return mutants, []
    objects = {program: build.affected(program) for program in room.programs}
    build.compile(sorted(set().union(*objects.values())))
    programs = []
    for program in room.programs:
        path = build.link(program, objects[program])
        programs.append((path, running.measure(path, mutants[-1].number + 1, options.tests)))
    return mutants, programs


def report(options, room, mutants, keys, answers):
    """Prints the survivors and the score. Returns whether it is as good as is wanted."""
    equivalent = explained()
    lines, counts = [], collections.Counter()
    for mutant in mutants:
        answer = answers.get(mutant.number)
        if answer is None:
            continue
        if answer in ("survived", "not reached") and keys[mutant.number] in equivalent:
            answer = "equivalent"
        counts[answer if answer in ("survived", "not reached", "equivalent", "time") else
               "found"] += 1
        if answer in ("survived", "not reached"):
            lines.append(f"{mutant.file}:{mutant.line}: {answer}: `{mutant.function}`: "
                         f"``{keys[mutant.number][2]}``")
    print("\n".join(sorted(lines)))
    found = counts["found"] + counts["time"]
    judged = found + counts["survived"] + counts["not reached"]
    score = 100.0 * found / judged if judged else 100.0
    dropped = sum(m.dropped for m in mutants)
    print(f"{options.room}: {score:.1f} % found ({found} of {judged}; {counts['time']} by time), "
          f"{room.wanted} % wanted; {counts['equivalent']} more are equivalent; "
          f"{dropped} of {len(mutants)} changes do not compile")
    return score >= room.wanted


def main():
    options = arguments()
    room, names = chosen_files(options)
    mutants, programs = built(room, names, options)
    keys = numbered(mutants)
    if options.list:
        for mutant in mutants:
            print(f"{mutant.file}:{mutant.line}: `{mutant.function}`: ``{keys[mutant.number][2]}``")
        return 0
    store = ROOT / "build" / "mutants" / options.room / "answers.json"
    earlier = {tuple(k): a for k, a in json.loads(store.read_text())} if store.exists() else {}
    numbers = [m.number for m in mutants if not m.dropped]
    if options.survivors:
        numbers = [n for n in numbers if earlier.get(keys[n]) in ("survived", "not reached")]
    if options.sample and options.sample < len(numbers):
        numbers = sorted(random.Random(options.seed).sample(numbers, options.sample))
    answers = {}

    def told(number, answer):
        answers[number] = answer
        earlier[keys[number]] = answer
        if answer in ("survived", "not reached"):
            print(f"{answer}: {': '.join(keys[number])}", flush=True)
        if len(answers) % 50 == 0:
            store.write_text(json.dumps([[list(k), a] for k, a in earlier.items()], indent=0))
            print(f"{len(answers)} of {len(numbers)}", flush=True)

    seconds = running.judge_all(programs, numbers, options.jobs, told)
    store.write_text(json.dumps([[list(k), a] for k, a in earlier.items()], indent=0))
    good = report(options, room, mutants, keys, answers)
    print(f"{len(numbers)} mutants in {seconds:.0f} s; seed {options.seed}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
