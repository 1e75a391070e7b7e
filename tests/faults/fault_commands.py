# SPDX-License-Identifier: MIT
"""The commands whose calls to the system are made to fail, and what they leave."""
import csv
import io
import json
import os
import re
import shutil
import subprocess

WORLD = {
    "sensor": "sensor.json", "scans": 2, "range_m": [1.0, 40.0], "seed": 3,
    "terrain": {"hills_m": 0.1, "margin_m": 30, "grid_m": 4.0},
    "roads": [{"name": "road", "points": [[-40, 0], [40, 0]], "width_m": 6}],
    "places": [{"part": "container", "at": [12, 8]}],
    "movers": [{"kind": "car", "road": "road", "lane_m": -1.5, "start_m": 45, "speed": 4}],
    "ego": {"road": "road", "lane_m": 1.5, "start_m": 30, "speed": 5, "body": "none"},
}
SENSOR = {
    "kind": "spinning", "banks": [{"from_deg": 10, "to_deg": -20, "count": 8}],
    "azimuth_step_deg": 3.0, "range_m": [1.0, 40.0], "noise_m": 0.01,
}
SUITE = {
    "name": "small", "controls": False, "threads": 1, "protocols": ["erasor"],
    "sequences": [{"path": "../base/data", "name": "a"}], "methods": ["noop", "raymoval:online"],
}


def run(program, arguments, folder, environment, seconds=180):
    """Runs the program in a folder. Returns its exit code (None: it hangs) and what it printed."""
    try:
        done = subprocess.run([program, *arguments], cwd=folder, env=environment,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=seconds)
    except subprocess.TimeoutExpired as error:
        return None, "", (error.stderr or b"").decode(errors="replace")
    return (done.returncode, done.stdout.decode(errors="replace"),
            done.stderr.decode(errors="replace"))


def without_times(value):
    """A JSON value without what differs from run to run."""
    if isinstance(value, dict):
        return {key: without_times(one) for key, one in value.items()
                if key not in ("checksum", "measured")}
    return [without_times(one) for one in value] if isinstance(value, list) else value


def content(path):
    """What a file says, without times; None for JSON that is damaged."""
    with open(path, "rb") as file:
        raw = file.read()
    name = os.path.basename(path)
    try:
        if name.endswith(".json"):
            return without_times(json.loads(raw))
        if name.endswith(".csv"):
            rows = list(csv.DictReader(io.StringIO(raw.decode())))
            return [{key: value for key, value in row.items()
                     if "seconds" not in key and "memory" not in key} for row in rows]
        if name in ("table.md", "table.tex"):
            return re.split(r"Time of", raw.decode())[0]
    except ValueError:
        return None
    return raw


def state(folder):
    """Every file below a folder with what it says. A lock that is left says nothing: the next
    process takes it."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            if name.endswith(".lock"):
                continue
            path = os.path.join(place, name)
            found[os.path.relpath(path, folder)] = content(path)
    return found


def unfinished(names):
    return sorted(name for name in names if name.endswith(".part") or ".part/" in name)


class Command:
    """A command: its words, what stands in its folder before, and whether cells may fail."""

    def __init__(self, name, arguments, inputs, has_cells=False, once=False):
        self.name = name
        self.arguments = arguments
        self.inputs = inputs  # names in base -> names in the folder
        self.has_cells = has_cells
        self.once = once  # It refuses to replace its output.

    def prepare(self, base, folder):
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        for source, target in self.inputs.items():
            source, target = os.path.join(base, source), os.path.join(folder, target)
            if os.path.isdir(source):
                shutil.copytree(source, target, dirs_exist_ok=True)
            else:
                shutil.copy(source, target)


CLEAN = ["clean", "../base/data", "-o", "map.pcd", "--dynamic", "removed.pcd", "--labels",
         "labels", "--method", "raymoval:online", "--force", "--threads", "1", "--quiet",
         "--overwrite"]
COMMANDS = [
    Command("run", ["run", "suite.json", "--quiet", "--keep-removals", "--out", "run"],
            {"suite.json": "suite.json"}, has_cells=True),
    Command("resume", ["run", "suite.json", "--quiet", "--keep-removals", "--out", "run"],
            {"suite.json": "suite.json", "half": "run"}, has_cells=True),
    Command("clean", CLEAN, {"old": "."}),
    Command("simulate", ["simulate", "world.json", "-o", "scene", "--threads", "1", "--quiet"],
            {"world.json": "world.json", "sensor.json": "sensor.json"}, once=True),
    Command("report", ["report", "../base/run", "-o", "page.html", "--overwrite", "--threads", "1",
                       "--quiet"],
            {}),
    Command("picture", ["picture", "../base/run", "--kind", "map", "-o", "map.png", "--overwrite",
                        "--threads", "1", "--quiet"], {}),
    Command("compare", ["compare", "../base/run", "../base/half.json", "--format", "junit", "-o",
                        "moved.xml", "--overwrite"], {}),
]


def must(code, text):
    if code != 0:
        raise SystemExit(f"fault_campaign.py: the inputs cannot be made: {text}")


def make_inputs(program, base, environment):
    """Makes what the commands read."""
    os.makedirs(base)

    def make(*arguments):
        code, _, text = run(program, arguments, base, environment)
        must(code, " ".join(arguments) + ": " + text)

    for name, value in (("world.json", WORLD), ("sensor.json", SENSOR), ("suite.json", SUITE)):
        with open(os.path.join(base, name), "w") as file:
            json.dump(value, file)
    make("simulate", "world.json", "-o", "data", "--threads", "1", "--quiet")
    make("run", "suite.json", "--quiet", "--keep-removals", "--out", "run")
    shutil.copy(os.path.join(base, "run/results.json"), os.path.join(base, "half.json"))
    # A run that died: one cell is there, of the other cell only its removals.
    shutil.copytree(os.path.join(base, "run"), os.path.join(base, "half"))
    for name in ("results.json", "results.csv", "table.md", "table.tex"):
        os.remove(os.path.join(base, "half", name))
    os.remove(os.path.join(base, "half/cells/a/raymoval-online/cell.json"))
    # Outputs of another method, to be replaced.
    os.makedirs(os.path.join(base, "old"))
    other = [{"raymoval:online": "remove-all"}.get(word, word) for word in CLEAN]
    other = [os.path.join("old", word) if word in ("map.pcd", "removed.pcd", "labels") else word
             for word in other]
    other[1] = "data"
    make(*other)
