# SPDX-License-Identifier: MIT
"""Runs the tests that reach a mutant, with the mutant switched on."""

import concurrent.futures
import dataclasses
import os
import re
import resource
import signal
import subprocess
import tempfile
import time

_MEMORY = 6 << 30


@dataclasses.dataclass
class Case:
    """A test case, its processor seconds and the numbers of the mutants that it reaches."""
    name: str
    seconds: float
    reached: set


def _spec(name):
    return re.sub(r'([\\",\[\]])', r"\\\1", name)


def run(program, names, environment, seconds):
    """Runs test cases up to the first failure. Returns "passed", "failed", "time" or a signal."""
    limits = ["prlimit", f"--cpu={int(seconds) + 1}:{int(seconds) + 2}", f"--as={_MEMORY}",
              "--core=0"]
    # What a test's processes still write while the folder is removed is no matter.
    with tempfile.TemporaryDirectory(prefix="raymoval-mutant-",
                                     ignore_cleanup_errors=True) as place:
        child = subprocess.Popen(
            limits + [str(program), ",".join(map(_spec, names)), "--abort"],
            env={**os.environ, **environment, "TMPDIR": place}, cwd=place,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True)
        try:
            code = child.wait(timeout=20 * seconds + 30)
        except subprocess.TimeoutExpired:
            code = -signal.SIGXCPU
        finally:
            try:
                os.killpg(child.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            child.wait()
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return "time"
    return "passed" if code == 0 else "failed" if code > 0 else f"signal {-code}"


def names_of_cases(program, choice):
    """The names of a test program's cases, one in each line. Catch2 2 and 3 have different options."""
    listed = None
    for option in (["--list-test-names-only"], ["--list-tests", "--verbosity", "quiet"]):
        listed = subprocess.run([str(program), *filter(None, [choice]), *option],
                                capture_output=True, text=True, check=False)
        # Version 2 ends with the number of cases, version 3 with an error for what it does not know.
        if listed.stdout and "Unrecognised token" not in listed.stderr + listed.stdout:
            break
    return listed.stdout


def measure(program, count, choice=""):
    """Runs each test case by itself without a mutant, and notes which mutants it reaches."""
    cases = []
    with tempfile.NamedTemporaryFile() as reached:
        for name in filter(None, names_of_cases(program, choice).splitlines()):
            reached.truncate(0)
            reached.truncate(max(count, 1))
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            answer = run(program, [name], {"RAYMOVAL_MUTANTS_REACHED": reached.name}, 600)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if answer != "passed":
                print(f"mutate.sh: {program.name}: '{name}': {answer} without any mutant; "
                      "it is left out", flush=True)
                continue
            with open(reached.name, "rb") as file:
                numbers = {i for i, byte in enumerate(file.read()) if byte}
            cases.append(Case(name, after.ru_utime + after.ru_stime - before.ru_utime -
                              before.ru_stime, numbers))
    return cases


def judge(programs, number):
    """Whether a test finds the mutant. `programs` are (path, cases). Returns what became of it."""
    reached = False
    for program, cases in programs:
        mine = sorted((c for c in cases if number in c.reached), key=lambda c: c.seconds)
        reached = reached or bool(mine)
        quick = [c for c in mine if c.seconds < 0.2][:12]
        for group in (quick, [c for c in mine if c not in quick]):
            if not group:
                continue
            allowed = 5 * sum(c.seconds for c in group) + 2
            answer = run(program, [c.name for c in group], {"RAYMOVAL_MUTANT": str(number)},
                         allowed)
            if answer != "passed":
                return answer
    return "survived" if reached else "not reached"


def judge_all(programs, numbers, jobs, told):
    """Judges mutants, `jobs` at a time; calls `told(number, answer)` as soon as one is known."""
    began = time.monotonic()
    pool = concurrent.futures.ThreadPoolExecutor(jobs)
    try:
        judged = {pool.submit(judge, programs, number): number for number in numbers}
        for answer in concurrent.futures.as_completed(judged):
            told(judged[answer], answer.result())
    finally:
        pool.shutdown(cancel_futures=True)  # Where it is stopped, the others are not waited for.
    return time.monotonic() - began
