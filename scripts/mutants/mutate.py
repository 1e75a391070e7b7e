# SPDX-License-Identifier: MIT
"""See scripts/mutate.sh."""

import argparse
import collections
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys

import rooms
import running

ROOT = pathlib.Path(__file__).resolve().parents[2]
EQUIVALENT = ROOT / "tests" / "mutants" / "equivalent.md"
LEFT = ("survived", "not reached")


def arguments():
    parser = argparse.ArgumentParser(prog="mutate.sh", allow_abbrev=False)
    parser.add_argument("--room", choices=list(rooms.ROOMS), default="eval")
    parser.add_argument("--file", action="append", default=[])
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--tests", default="")
    parser.add_argument("--survivors", action="store_true")
    parser.add_argument("--unexplained", action="store_true")
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
    build = building.MutatedBuild(release, ROOT / "build" / "mutants" / options.room, options.jobs,
                                  room.headers_seen_by)
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
    """Prints the survivors, what was found in each file and the score. Returns whether it is as
    good as is wanted."""
    equivalent = explained()
    lines, counts = [], collections.defaultdict(collections.Counter)
    for mutant in mutants:
        answer = answers.get(mutant.number)
        if options.unexplained and keys[mutant.number] in equivalent:
            answer = "survived"
        if answer is None or mutant.dropped:
            continue
        left = answer in LEFT
        is_explained = left and keys[mutant.number] in equivalent
        kind = "explained" if is_explained else "left" if left else "found"
        counts[mutant.file].update([kind, "all"] + (["time"] if answer == "time" else []))
        if kind == "left":
            lines.append(f"{mutant.file}:{mutant.line}: {answer}: `{mutant.function}`: "
                         f"``{keys[mutant.number][2]}``")
    print("\n".join(sorted(lines)))
    for file, of_file in counts.items():
        print(f"{file}: {of_file['all']} mutants, {of_file['found']} found, "
              f"{of_file['explained']} explained, {of_file['left']} left")
    total = sum(counts.values(), collections.Counter())
    judged = total["found"] + total["left"]
    score = 100.0 * total["found"] / judged if judged else 100.0
    dropped = sum(m.dropped for m in mutants)
    print(f"{options.room}: {score:.1f} % found ({total['found']} of {judged}; {total['time']} by "
          f"time), {room.wanted} % wanted; {total['explained']} more are equivalent; "
          f"{len(mutants) - dropped - total['all']} were not tried; "
          f"{dropped} of {len(mutants)} changes do not compile")
    return score >= room.wanted


class Answers:
    """What became of mutants, in this run and in earlier ones."""

    def __init__(self, store, keys):
        self.store, self.keys = store, keys
        self.now = {}  # By number.
        self.known = {}  # By key.
        if store.exists():
            self.known = {tuple(k): a for k, a in json.loads(store.read_text())}

    def told(self, number, answer):
        self.now[number] = self.known[self.keys[number]] = answer
        if answer in LEFT:
            print(f"{answer}: {': '.join(self.keys[number])}", flush=True)
        if len(self.now) % 20 == 0:
            self.save()

    def save(self):
        part = self.store.with_suffix(".part")
        part.write_text(json.dumps([[list(k), a] for k, a in self.known.items()], indent=0))
        part.replace(self.store)

    def of(self, number):
        """The latest answer; None if there is none."""
        return self.known.get(self.keys[number])


def chosen_numbers(options, mutants, answers):
    numbers, known = [m.number for m in mutants if not m.dropped], explained()
    if options.unexplained:
        numbers = [n for n in numbers if answers.keys[n] not in known]
    if options.survivors:
        numbers = [n for n in numbers if answers.of(n) is None or
                   answers.of(n) in LEFT and answers.keys[n] not in known]
    if options.sample and options.sample < len(numbers):
        numbers = sorted(random.Random(options.seed).sample(numbers, options.sample))
    return numbers


def judged_numbers(programs, numbers, options, answers):
    """Judges mutants. However it ends, what is known by then is kept."""
    def told(number, answer):
        answers.told(number, answer)
        if len(answers.now) % 50 == 0:
            print(f"{len(answers.now)} of {len(numbers)}", flush=True)

    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    try:
        return running.judge_all(programs, numbers, options.jobs, told)
    finally:
        answers.save()


def main():
    options = arguments()
    room, names = chosen_files(options)
    mutants, programs = built(room, names, options)
    keys = numbered(mutants)
    if options.list:
        for mutant in mutants:
            print(f"{mutant.file}:{mutant.line}: `{mutant.function}`: ``{keys[mutant.number][2]}``")
        return 0
    answers = Answers(ROOT / "build" / "mutants" / options.room / "answers.json", keys)
    numbers = chosen_numbers(options, mutants, answers)
    seconds = judged_numbers(programs, numbers, options, answers)
    shown = {n: answers.of(n) for n in keys} if options.survivors else answers.now
    good = report(options, room, mutants, keys, shown)
    print(f"{len(numbers)} mutants in {seconds:.0f} s; seed {options.seed}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
