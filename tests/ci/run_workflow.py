#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the steps of a GitHub workflow or of a composite action on this machine.

    run_workflow.py FILE [--job NAME] [--matrix KEY=VALUE ...] [--input KEY=VALUE ...]
                    [--set CONTEXT.KEY=VALUE ...] [--only TEXT ...] [--folder DIR] [--cache DIR] [--list]

`run:` steps are run as a runner does it, by bash, with GITHUB_OUTPUT, GITHUB_ENV, GITHUB_PATH and
GITHUB_STEP_SUMMARY. Of `uses:` it knows checkout (the folder is there already), the cache (a folder),
artifacts (what is uploaded has to be there), and actions of this repository. Any other is an error,
so that a workflow does not look checked that is not. --only runs the steps with TEXT in their name.
The container and the machine that a job asks for are not made: the steps run where this runs.

The exit code is that of the first step that failed, 2 for a workflow that cannot be run.
"""

import argparse
import glob
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import yaml

TOKEN = re.compile(r"\s*(?:(==|!=|&&|\|\||[!(),])|'((?:[^']|'')*)'|(\d+)|([A-Za-z_][\w.-]*))")


class Unknown(Exception):
    """Something in a workflow that this program does not know."""


class Expression:
    """GitHub's expressions, as far as workflows here use them: names, texts, ==, !=, &&, || and !."""

    def __init__(self, text, contexts):
        self.text, self.contexts, self.tokens, at = text, contexts, [], 0
        while text[at:].strip():
            found = TOKEN.match(text, at)
            if not found:
                raise Unknown(f"'{text}' is no expression that is known here")
            self.tokens.append(found)
            at = found.end()

    def value(self):
        result = self.either()
        if self.tokens:
            raise Unknown(f"'{self.text}': '{self.tokens[0].group().strip()}' is not expected there")
        return result

    def takes(self, sign):
        if self.tokens and self.tokens[0].group(1) == sign:
            self.tokens.pop(0)
            return True
        return False

    def either(self):
        result = self.both()
        while self.takes("||"):
            other = self.both()
            result = result or other
        return result

    def both(self):
        result = self.compared()
        while self.takes("&&"):
            other = self.compared()
            result = result and other
        return result

    def compared(self):
        result = self.single()
        if self.takes("=="):
            return result == self.single()
        if self.takes("!="):
            return result != self.single()
        return result

    def single(self):
        if self.takes("!"):
            return not self.single()
        if self.takes("("):
            result = self.either()
            if not self.takes(")"):
                raise Unknown(f"'{self.text}': a ) is missing")
            return result
        if not self.tokens:
            raise Unknown(f"'{self.text}' ends too soon")
        token = self.tokens.pop(0)
        if token.group(2) is not None:
            return token.group(2).replace("''", "'")
        if token.group(3):
            return int(token.group(3))
        if self.takes("("):
            return self.function(token.group(4))
        return self.name(token.group(4))

    def function(self, name):
        given = []
        while not self.takes(")"):
            given.append(self.either())
            self.takes(",")
        if name == "startsWith":
            return str(given[0]).startswith(str(given[1]))
        if name in ("always", "success", "failure"):
            return {"always": True, "success": not self.contexts["failed"],
                    "failure": self.contexts["failed"]}[name]
        raise Unknown(f"'{self.text}': the function {name} is not known here")

    def name(self, name):
        first, *rest = name.split(".")
        if first in ("true", "false"):
            return first == "true"
        if first not in self.contexts:
            raise Unknown(f"'{self.text}': there is no context '{first}' here")
        value = self.contexts[first]
        for key in rest:
            value = value.get(key, "") if isinstance(value, dict) else ""
        return value


def filled(text, contexts):
    """A text with its ${{ }} replaced."""
    def replaced(found):
        value = Expression(found.group(1), contexts).value()
        return str(value).lower() if isinstance(value, bool) else str(value)
    return re.sub(r"\$\{\{(.*?)\}\}", replaced, str(text), flags=re.S)


class Runner:
    """Runs steps in a folder, with what they tell each other."""

    def __init__(self, folder, cache, contexts, only):
        self.folder, self.cache, self.only = folder, cache, only
        self.contexts = {"failed": False, "steps": {}, "env": {}, "inputs": {}, "matrix": {},
                         "secrets": {}, "job": {}, **contexts}
        self.at_end, self.work = [], pathlib.Path(tempfile.mkdtemp())
        self.summary = self.work / "summary.md"
        self.summary.touch()
        self.environment = {}
        self.ran = 0

    def condition(self, step):
        text = str(step.get("if", "success()"))
        text = text.strip().removeprefix("${{").removesuffix("}}")
        if not re.search(r"\b(always|success|failure)\(", text):
            text = f"success() && ({text})"
        return Expression(text, self.contexts).value()

    def steps(self, steps):
        """Runs steps in turn; returns the exit code of the first that failed, or 0."""
        status = 0
        for step in steps:
            name = step.get("name") or step.get("uses") or str(step.get("run")).splitlines()[0]
            if self.only and not any(text in name for text in self.only):
                continue
            if not self.condition(step):
                print(f"-- {name}: left out", flush=True)
                continue
            print(f"-- {name}", flush=True)
            self.ran += 1
            code = self.uses(step) if "uses" in step else self.run(step)
            if code and not step.get("continue-on-error"):
                status = status or code
                self.contexts["failed"] = True
        for action in self.at_end:
            action()
        self.at_end = []
        return status

    def run(self, step):
        told = {name: self.work / name for name in ("output", "env", "path")}
        for file in told.values():
            file.write_text("")
        script = self.work / "step.sh"
        script.write_text(filled(step["run"], self.contexts))
        env = {**os.environ, **self.environment,
               **{key: filled(value, self.contexts) for key, value in self.contexts["env"].items()},
               **{key: filled(value, self.contexts) for key, value in step.get("env", {}).items()},
               "CI": "true", "GITHUB_OUTPUT": str(told["output"]), "GITHUB_ENV": str(told["env"]),
               "GITHUB_PATH": str(told["path"]), "GITHUB_STEP_SUMMARY": str(self.summary)}
        how = {"bash": ["bash", "--noprofile", "--norc", "-eo", "pipefail"], None: ["bash", "-e"]}
        shell = step.get("shell")
        if shell not in how:
            raise Unknown(f"the shell '{shell}' is not known here")
        folder = self.folder / filled(step.get("working-directory", "."), self.contexts)
        code = subprocess.run([*how[shell], str(script)], cwd=folder, env=env, check=False,
                              stdin=subprocess.DEVNULL).returncode
        pairs = [line.split("=", 1) for line in told["output"].read_text().splitlines() if "=" in line]
        if "id" in step:
            self.contexts["steps"][step["id"]] = {"outputs": dict(pairs)}
        self.environment.update(line.split("=", 1) for line in told["env"].read_text().splitlines())
        for line in told["path"].read_text().splitlines():
            self.environment["PATH"] = line + ":" + self.environment.get("PATH", os.environ["PATH"])
        return code

    def uses(self, step):
        name = step["uses"].split("@")[0]
        given = {key: filled(value, self.contexts) for key, value in step.get("with", {}).items()}
        if name == "actions/checkout":
            return 0
        if name.startswith("actions/cache"):
            if not name.endswith("save"):
                self.restore(given)
            if name == "actions/cache":
                self.at_end.append(lambda: self.save(given))
            elif name.endswith("save"):
                self.save(given)
            return 0
        if name == "actions/upload-artifact":
            for pattern in given["path"].split():
                if not glob.glob(str(self.folder / pattern)):
                    print(f"run_workflow.py: {pattern}: there is no such file to upload", file=sys.stderr)
                    return 1
            return 0
        if name.startswith("./"):
            return self.action(self.folder / name / "action.yml", given)
        raise Unknown(f"the action '{step['uses']}' is not known here")

    def action(self, file, given):
        """A composite action, which has inputs and steps of its own."""
        action = yaml.safe_load(file.read_text())
        inputs = {}
        for key, what in (action.get("inputs") or {}).items():
            if what.get("required") and key not in given:
                raise Unknown(f"{file}: the input '{key}' is missing")
            inputs[key] = given.get(key, what.get("default", ""))
        unknown = set(given) - set(inputs)
        if unknown:
            raise Unknown(f"{file}: there is no input '{sorted(unknown)[0]}'")
        inner = Runner(self.folder, self.cache, {**self.contexts, "inputs": inputs, "steps": {}}, [])
        inner.environment, inner.summary = self.environment, self.summary
        github = {**self.contexts["github"], "action_path": str(file.parent.resolve())}
        inner.contexts["github"] = github
        status = inner.steps(action["runs"]["steps"])
        self.ran += inner.ran
        return status

    def place(self, key):
        return self.cache / re.sub(r"[^\w.-]", "_", key)

    def restore(self, given):
        path = pathlib.Path(os.path.expanduser(self.folder / pathlib.Path(given["path"]).expanduser()))
        wanted = [self.place(given["key"])]
        for start in given.get("restore-keys", "").split():
            kept = glob.glob(glob.escape(str(self.place(start))) + "*")
            wanted += sorted(map(pathlib.Path, kept), key=os.path.getmtime, reverse=True)
        for kept in wanted:
            if kept.exists():
                shutil.copytree(kept, path, dirs_exist_ok=True)
                return

    def save(self, given):
        path = self.folder / pathlib.Path(given["path"]).expanduser()
        if path.exists() and not self.place(given["key"]).exists():
            shutil.copytree(path, self.place(given["key"]))


def pairs(texts):
    for text in texts:
        if "=" not in text:
            raise Unknown(f"'{text}': expected KEY=VALUE")
    return dict(text.split("=", 1) for text in texts)


def matrices(job):
    """Every combination of a job's matrix: those of its lists, and those that it includes."""
    matrix = dict(job.get("strategy", {}).get("matrix", {}))
    extra = matrix.pop("include", [])
    combined = [{}]
    for key, values in matrix.items():
        combined = [{**one, key: value} for one in combined for value in values]
    return (combined if matrix else []) + extra or [{}]


def chosen_matrix(job, wanted):
    for one in matrices(job):
        if all(str(one.get(key)) == value for key, value in wanted.items()):
            return one
    raise Unknown(f"no combination of the matrix has {wanted}")


def run_file(options):
    file = pathlib.Path(options.file)
    document = yaml.safe_load(file.read_text())
    github = {"ref_name": "main", "run_id": "1", "sha": "0" * 40, "repository": "somebody/raymoval",
              "event": {"repository": {"default_branch": "main"}}, "action_ref": ""}
    contexts = {"github": github, "runner": {"os": "Linux", "arch": "X64"}}
    for name, value in pairs(options.set).items():
        place = contexts
        *keys, last = name.split(".")
        for key in keys:
            place = place.setdefault(key, {})
        place[last] = value
    runner = Runner(pathlib.Path(options.folder).resolve(), pathlib.Path(options.cache or tempfile.mkdtemp()),
                    contexts, options.only)
    if "runs" in document:
        status = runner.action(file, pairs(options.input))
    else:
        jobs = document["jobs"]
        name = options.job or next(iter(jobs))
        if name not in jobs:
            raise Unknown(f"there is no job '{name}'; expected one of {', '.join(jobs)}")
        if options.list:
            for one in matrices(jobs[name]):
                print(" ".join(f"{key}={value}" for key, value in one.items()))
            return 0
        runner.contexts["matrix"] = chosen_matrix(jobs[name], pairs(options.matrix))
        runner.contexts["env"] = {**document.get("env", {}), **jobs[name].get("env", {})}
        status = runner.steps(jobs[name]["steps"])
    print(runner.summary.read_text(), end="")
    if runner.ran == 0:
        raise Unknown("no step was run")
    return status


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--job")
    for option in ("--matrix", "--input", "--set", "--only"):
        parser.add_argument(option, action="append", default=[])
    parser.add_argument("--folder", default=".")
    parser.add_argument("--cache")
    parser.add_argument("--list", action="store_true", help="print the job's matrix, a line each")
    options = parser.parse_args()
    try:
        sys.exit(run_file(options))
    except (Unknown, OSError, yaml.YAMLError, KeyError) as error:
        print(f"run_workflow.py: {options.file}: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
