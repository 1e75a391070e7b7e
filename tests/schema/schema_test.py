#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks results/schema/ against what the program writes and reads.

Usage: schema_test.py PATH/TO/raymoval
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
failures = []
checks = 0


def check(name, good, detail=""):
    global checks
    checks += 1
    if not good:
        failures.append(f"{name}: {detail}")


def schema(name):
    content = json.loads((ROOT / "results/schema" / f"{name}.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(content)
    return jsonschema.Draft202012Validator(content)


def without_comments(text):
    """JSON with // and /* */ comments as plain JSON; texts stay as they are."""
    pattern = r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/'
    keep = lambda match: match.group(0) if match.group(0).startswith('"') else " "
    return re.sub(pattern, keep, text, flags=re.DOTALL)


def first_error(validator, document):
    error = next(iter(validator.iter_errors(document)), None)
    return "" if error is None else f"{list(error.absolute_path)}: {error.message}"


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)


def check_valid(name, validator, document):
    check(f"{name} is valid", first_error(validator, document) == "",
          first_error(validator, document))


def mutations(document):
    """The document with each of its keys renamed, taken away, or given a value of another type."""
    for key, value in document.items():
        renamed = {k + "x" if k == key else k: v for k, v in document.items()}
        yield f"'{key}' renamed", renamed
        if key != "missing":
            yield f"without '{key}'", {k: v for k, v in document.items() if k != key}
        yield f"'{key}' as a list of lists", {**document, key: [[[]]]}


def check_results(folder):
    suite = {"sequences": [{"path": "street", "frames": "0:2"}],
             "methods": ["raymoval:online"], "threads": 1}
    (folder / "suite.json").write_text(json.dumps(suite))
    made = run("run", str(folder / "suite.json"), "--quiet", "--out", str(folder / "run"))
    check("the run is made", made.returncode == 0, made.stderr)
    partial = run("run", str(folder / "suite.json"), "--quiet", "--only", "noop*",
                  "--out", str(folder / "partial"))
    check("the part is made", partial.returncode == 0, partial.stderr)
    cell = folder / "run/cells/street/raymoval-online"
    documents = [("cell", cell / "cell.json"), ("results", folder / "run/results.json"),
                 ("results", folder / "partial/results.json"),
                 ("results", ROOT / "results/reference/street/results.json")]
    for name, path in documents:
        document = json.loads(path.read_text())
        validator = schema(name)
        check_valid(path.name, validator, document)
        for what, changed in mutations(document):
            check(f"{path.name} {what} is invalid", first_error(validator, changed) != "")
    cells = json.loads((folder / "run/results.json").read_text())["cells"]
    for item in cells:  # The cells within are as those outside.
        check_valid("a cell of results.json", schema("cell"), {**item, "checksum": ""})
    for arguments in [(), ("--out", str(folder / "run"))]:
        plan = run("plan", str(folder / "suite.json"), "--quiet", *arguments)
        check("the plan is made", plan.returncode == 0, plan.stderr)
        for line in plan.stdout.splitlines():
            check_valid("a line of the plan", schema("plan"), json.loads(line))


def suites():
    """Suites with whether they are legal; schema and program have to agree on each."""
    base = {"sequences": [{"path": "street", "frames": "0:0"}], "methods": ["noop"]}

    def method(**more):
        return {**base, "methods": ["noop", {"method": "raymoval:online", **more}]}

    def sequence(**more):
        return {**base, "sequences": [{"path": "street", "frames": "0:0", **more}]}

    def protocol(**more):
        return {**base, "protocols": [{"protocol": "erasor", **more}]}

    yield True, base
    yield True, {**base, "name": "mine", "protocols": ["erasor"], "controls": False, "threads": 2,
                 "time_limit_s": 0.5, "memory_limit_mib": 100}
    yield True, sequence(name="a", range_m={"min": 1, "max": 50}, sensor="hdl64e")
    yield True, method(**{"set": {"tau0": 0.2}, "as": "b:c"})
    yield True, method(set={"tau0": {"sweep": [0.2, 0.3]}, "tau1": 0.3})
    yield True, protocol(**{"set": {"voxel_size": 0.3}, "as": "coarse"})
    for key, value in [("threads", 0), ("threads", 1.5), ("threads", "2"), ("time_limit_s", 0),
                       ("time_limit_s", "1"), ("memory_limit_mib", -1), ("controls", 1),
                       ("name", 3), ("methods", []), ("methods", [7]), ("sequences", []), ("sequences", "street"),
                       ("protocols", [None]), ("thread", 1)]:
        yield False, {**base, key: value}
    yield False, {"methods": ["noop"]}
    yield False, {"sequences": ["street"]}
    yield False, []
    for more in [{"name": 1}, {"frames": 3}, {"range_m": {"minimum": 1}}, {"range_m": {"min": "1"}},
                 {"stride": 2}]:
        yield False, sequence(**more)
    for more in [{"set": []}, {"set": {"tau0": {"sweep": []}}}, {"set": {"tau0": {"swep": [1]}}},
                 {"set": {"tau0": {"sweep": 1}}}, {"set": {"tau0": {}}}, {"set": {"tau0": [1]}},
                 {"set": {"tau0": {"sweep": [[1]]}}}, {"as": "a/b"}, {"as": ".a"}, {"sett": {}}]:
        yield False, method(**more)
    for more in [{"set": {"voxel_size": {"sweep": [1]}}}, {"as": "a b"}, {"options": {}}]:
        yield False, protocol(**more)
    yield False, {**base, "methods": [{"as": "x"}]}
    yield False, {**base, "protocols": [{"as": "x"}]}
    yield False, {**base, "sequences": [{"name": "x"}]}


def check_suites(folder):
    validator = schema("suite")
    for path in sorted((ROOT / "benchmark/suites").glob("*.json")):
        check_valid(path.name, validator, json.loads(without_comments(path.read_text())))
    file = folder / "tried.json"
    for legal, suite in suites():
        text = json.dumps(suite)
        file.write_text(text)
        check(f"schema on {text}", (first_error(validator, suite) == "") == legal,
              first_error(validator, suite))
        tried = run("plan", str(file), "--quiet")
        check(f"program on {text}", tried.returncode == (0 if legal else 2), tried.stderr)


def manifests():
    """Manifests of external methods with whether they are legal."""
    base = {"name": "own", "sentence": "s", "version": "1", "online": True, "command": ["true"]}
    parameter = {"name": "a", "default": 2, "sentence": "s"}
    yield True, base
    yield True, {**base, "source": "", "notes": ["n"], "files": [], "time_limit_s": 0.5,
                 "disk_limit_gib": 2, "parameters": [{**parameter, "unit": "m", "minimum": 1,
                                                      "maximum": 2.5, "source": "here"}]}
    yield True, {**base, "parameters": [{**parameter, "default": "x", "choices": ["x", "y"]}]}
    yield True, {**base, "version": 1}
    yield False, {**base, "version": 1.5}
    for key in base:
        yield False, {k: v for k, v in base.items() if k != key}
    for key, value in [("name", "a/b"), ("name", ""), ("sentence", 1), ("online", "yes"),
                       ("command", []), ("command", "true"), ("command", [1]), ("notes", "n"),
                       ("time_limit_s", 0), ("disk_limit_gib", -1), ("parameters", {}),
                       ("variants", [])]:
        yield False, {**base, key: value}
    for key, value in [("name", "a b"), ("default", None), ("unit", 1), ("minimum", "0"),
                       ("choices", "x"), ("sentence", ""), ("range", [0, 1])]:
        yield False, {**base, "parameters": [{**parameter, key: value}]}
    yield False, []


def check_manifests(folder):
    validator = schema("manifest")
    for path in sorted((ROOT / "examples").rglob("manifest.json")):
        check_valid(str(path), validator, json.loads(without_comments(path.read_text())))
    file = folder / "manifest.json"
    for legal, manifest in manifests():
        text = json.dumps(manifest)
        file.write_text(text)
        check(f"schema on {text}", (first_error(validator, manifest) == "") == legal,
              first_error(validator, manifest))
        tried = run("describe", f"external:{file}")
        check(f"program on {text}", tried.returncode == (0 if legal else 2), tried.stderr)


with tempfile.TemporaryDirectory() as name:
    check_results(pathlib.Path(name))
    check_suites(pathlib.Path(name))
    check_manifests(pathlib.Path(name))
for failure in failures:
    print("FAILED:", failure)
print(f"schema: {checks - len(failures)} of {checks} checks hold")
sys.exit(1 if failures else 0)
