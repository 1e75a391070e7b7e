# SPDX-License-Identifier: MIT
"""Makes the test programs of a room with all mutants in them, beside the release build."""

import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys

import planting
import rooms
import source_text
import syntax


def _output(command, folder):
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


class ReleaseBuild:
    """What ninja knows of the release build: commands, and which files each object was made of."""

    def __init__(self, root, programs):
        self.root, self.folder = root, root / "build" / "release"
        # One object for each source file.
        subprocess.run(["cmake", "--preset", "release", "-DRAYMOVAL_UNITY="], cwd=root, check=True,
                       stdout=subprocess.DEVNULL)
        subprocess.run(["cmake", "--build", "--preset", "release", "--target", *programs],
                       cwd=root, check=True)
        edges = json.loads(_output(["ninja", "-t", "compdb"], self.folder))
        self.links = {e["output"]: e["command"] for e in edges}
        self.units = {}  # Object -> (source, command).
        for edge in edges:
            if edge["output"].endswith(".cpp.o") and " -c " in edge["command"]:
                source = (self.folder / edge["file"]).resolve()
                self.units[edge["output"]] = (source, edge["command"])
        self.dependencies = self._dependencies()

    def _dependencies(self):
        result, current = {}, None
        for line in _output(["ninja", "-t", "deps"], self.folder).splitlines():
            if line.startswith(" "):
                path = pathlib.Path(line.strip())
                result[current].add(str((self.folder / path).resolve()) if not path.is_absolute()
                                    else str(path))
            elif ":" in line:
                current = line.split(":")[0]
                result[current] = set()
        return result

    def objects_of(self, program):
        """Objects of the tests of a program, and those of the libraries that it is linked with."""
        tests = set(re.findall(r"\S+\.cpp\.o", self.links[program]))
        product = set()
        for library in set(re.findall(r"\S+\.a\b", self.links[program])):
            product |= set(re.findall(r"\S+\.cpp\.o", self.links.get(library, "")))
        return tests, product


class MutatedBuild:
    """A folder with the planted files of a room, their objects and the linked test programs."""

    def __init__(self, release, folder, jobs, headers_seen_by=()):
        self.release, self.folder, self.jobs = release, folder, jobs
        self.headers_seen_by = headers_seen_by
        self.sources, self.objects = folder / "source", folder / "objects"
        self.cache = folder.parent / "syntax"
        self.planted = {}  # Name of a file -> Planted.

    def plant(self, names):
        """Plants mutants in the files of these names."""
        self.sources.mkdir(parents=True, exist_ok=True)
        switch = self.sources / "mutant_switch.h"
        if not switch.exists() or switch.read_text() != planting.SWITCH:
            switch.write_text(planting.SWITCH)
        number = 0
        for name in names:
            place = self.release.root / name
            unit = self._unit_with(place)
            if unit is None:
                print(f"mutate.sh: {name}: no source file that is built includes it; left out",
                      file=sys.stderr)
                continue
            source = source_text.SourceText(place)
            places, constants, errors = syntax.places_of(source, *unit, self.cache)
            if errors:
                print(f"mutate.sh: {name}: clang says: {errors[0]}", file=sys.stderr)
            planted = planting.Planted(source, name, places, constants, number, self.sources)
            self.planted[name] = planted
            # Room for some more, so that a changed file does not number all others anew.
            number = (number + len(planted.mutants) + 70) // 50 * 50
        self._clear()
        print(f"{sum(len(p.mutants) for p in self.planted.values())} changes in "
              f"{len(self.planted)} files", flush=True)

    def _clear(self):
        """Takes away what an earlier run planted in files that are not chosen now: its numbers are
        those of other mutants."""
        for path in [p for p in self.sources.rglob("*") if p.is_file()]:
            name = str(path.relative_to(self.sources))
            if name == "mutant_switch.h" or name in self.planted:
                continue
            path.unlink()
            place = str(self.release.root / name)
            for made, (source, _) in self.release.units.items():
                if place == str(source) or place in self.release.dependencies.get(made, ()):
                    (self.objects / made).unlink(missing_ok=True)

    def _unit_with(self, place):
        """A source file that has `place` in it, and its command: itself or the nearest one."""
        best = None
        for name, (source, command) in sorted(self.release.units.items()):
            if source == place:
                return source, command
            near = source.parent == place.parent and source.stem == place.stem
            if str(place) in self.release.dependencies.get(name, ()) and (best is None or near):
                best = (source, command)
        return best

    def _mutated_command(self, name):
        """The command that makes object `name` of the planted files."""
        source, command = self.release.units[name]
        planted = self.sources / source.relative_to(self.release.root) \
            if source.is_relative_to(self.release.root) else source
        command = re.sub(r" -include \S+| -W\S+| -MD| -M[TF] \S+", "", command)
        command = re.sub(r" -O[0-9s]", "", command)
        command = re.sub(r" -o \S+ -c \S+", "", command)
        # A function that never returns may do so with a mutant, and the compiler has to believe it.
        extra = (f" -I{self.sources} -O1 -w -D_GLIBCXX_ASSERTIONS -Dnoreturn=maybe_unused"
                 " -Wno-narrowing -fsanitize=return -fsanitize-undefined-trap-on-error"
                 " -fdiagnostics-column-unit=byte"
                 f" -fmax-errors=0 -iquote {source.parent}")
        first, _, rest = command.partition(" -I") if " -I" in command else (command, "", "")
        command = first + extra + (" -I" + rest if rest else "")
        which = planted if planted.exists() else source
        return f"{command} -o {self._object(name)} -c {which}"

    def _object(self, name):
        path = self.objects / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def affected(self, program):
        """Objects that have a planted file in them."""
        tests, product = self.release.objects_of(program)
        places = {str(self.release.root / name) for name in self.planted}
        return sorted(o for o in (tests | product)
                      if o in self.release.dependencies and
                      (str(self.release.units[o][0]) in places or
                       self.release.dependencies[o] & places and self._sees_headers(o)))

    def _sees_headers(self, name):
        source = self.release.units[name][0]
        return not self.headers_seen_by or source.is_relative_to(self.release.root) and \
            rooms.fits(str(source.relative_to(self.release.root)), self.headers_seen_by)

    def compile(self, names):
        """Compiles these objects, and takes out mutants that do not compile."""
        pending, rounds = [n for n in names if not self._is_made(n)], 0
        while pending:
            rounds += 1
            if rounds > 25:
                raise SystemExit("mutate.sh: mutants do not compile after many rounds")
            print(f"compiling {len(pending)} files with mutants", flush=True)
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                failures = [f for f in pool.map(self._compile_one, pending) if f]
            pending = self._repaired(failures)

    def _is_made(self, name):
        """Whether an object is there and newer than all that it is made of."""
        if not self._object(name).exists():
            return False
        made = self._object(name).stat().st_mtime
        files = {pathlib.Path(f) for f in self.release.dependencies[name]}
        files |= {p.path for p in self.planted.values() if p.source.path in files}
        return all(f.stat().st_mtime < made for f in files | {self.sources / "mutant_switch.h"})

    def _compile_one(self, name):
        done = subprocess.run(["env", "LC_ALL=C", "sh", "-c", self._mutated_command(name)],
                              cwd=self.release.folder, capture_output=True, text=True,
                              errors="replace", check=False)
        return (name, done.stderr) if done.returncode != 0 else None

    def _repaired(self, failures):
        """Objects to compile once more."""
        pending, changed = {name for name, _ in failures}, set()
        for name, errors in failures:
            repaired = [p for p in self.planted.values()
                        if p.is_named_in(errors) and p.repair(errors)]
            if not repaired and not changed:
                raise SystemExit(f"mutate.sh: {name} does not compile:\n{errors[:3000]}")
            changed |= {str(p.source.path) for p in repaired if p.source.path.suffix == ".h"}
        for name in self.release.units:
            if self.release.dependencies.get(name, set()) & changed and \
                    (self.objects / name).exists():
                pending.add(name)
        return sorted(pending)

    def link(self, program, names):
        """Links a test program; what is mutated comes first, so that it is what is taken."""
        command = self.release.links[program].split(" && ")[1]
        tests = set(re.findall(r"\S+\.cpp\.o", command))
        for test in tests & set(names):
            command = command.replace(f" {test} ", f" {self._object(test)} ")
        product = " ".join(str(self._object(n)) for n in names if n not in tests)
        first = re.search(r" \S+\.cpp\.o", command).start()
        target = self.folder / program
        command = command[:first] + f" {product}" + command[first:]
        command = re.sub(rf" -o {program} ", f" -o {target} ", command)
        subprocess.run(["sh", "-c", command], cwd=self.release.folder, check=True)
        # Programs look for the suites and published tables that come with them beside themselves.
        shared = self.folder / "share"
        if not shared.is_symlink():
            shared.symlink_to(self.release.folder / "share")
        return target
