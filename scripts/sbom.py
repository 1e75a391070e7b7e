#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes what a build of raymoval is made of, as SPDX 2.3 JSON, and the list of licences.

    scripts/sbom.py BUILD_FOLDER --json raymoval.spdx.json --licences LICENCES.md

Nothing is typed in: which libraries a program loads is what ldd says, which headers were compiled in
is what ninja noted, which package a file is of and its version is what dpkg says, and the names of
licences are those of Debian's machine-readable copyright files. Which three.js the page of reports
holds is what CMake found. The time is SOURCE_DATE_EPOCH.
"""
import argparse
import datetime
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def output_of(*command, may_fail=False):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0 and not may_fail:
        sys.exit(f"sbom.py: {' '.join(command[:3])} ...: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def packages_of(paths):
    """The Debian package of each file; a file without one ends the program."""
    found = {}
    # dpkg knows some files by the place that they had before /lib became a link to /usr/lib.
    names = {str(name): path for path in paths for real in {path, os.path.realpath(path)}
             for name in (real, re.sub("^/usr/lib", "/lib", real), re.sub("^/lib", "/usr/lib", real))}
    for line in output_of("dpkg", "-S", *sorted(names), may_fail=True).splitlines():
        owners, _, file = line.partition(": ")
        if file in names and not owners.startswith("diversion"):
            found[names[file]] = owners.split(",")[0].split(":")[0]
    missing = sorted(set(paths) - set(found))
    if missing:
        sys.exit(f"sbom.py: no Debian package has {', '.join(missing[:5])}")
    return found


def loaded(binary):
    """The files of all libraries that a program loads, and the names of those that it asks for."""
    files = set(re.findall(r"=> (/\S+)", output_of("ldd", binary)))
    files |= set(re.findall(r"^\s*(/\S+) \(0x", output_of("ldd", binary), flags=re.M))
    needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", output_of("readelf", "-d", binary)))
    return files, needed


def headers(build):
    """Headers of the system that were compiled in."""
    text = output_of("ninja", "-C", build, "-t", "deps")
    found = {os.path.normpath(os.path.join(build, line.strip())) for line in text.splitlines()
             if line.startswith("    ")}
    return {path for path in found if path.startswith("/usr/") and os.path.exists(path)}


def copyright_file(package):
    return Path("/usr/share/doc") / package / "copyright"


def licences_of(package):
    """Names in the machine-readable copyright file; empty if there is none in that form."""
    file = copyright_file(package)
    text = file.read_text(encoding="utf-8", errors="replace") if file.exists() else ""
    if "Format:" not in text[:400]:
        return []
    return sorted({name.strip() for name in re.findall(r"^License:[ \t]*(\S.*)$", text, flags=re.M)})


def facts_of(package):
    form = "${Version}\t${source:Package}\t${source:Version}\t${Architecture}\t${Homepage}\n"
    version, source, source_version, architecture, homepage = output_of(
        "dpkg-query", "-W", "-f", form, package).splitlines()[0].split("\t")
    return {"version": version, "source": f"{source} {source_version}",
            "architecture": architecture, "homepage": homepage, "licences": licences_of(package)}


def found_in(file, pattern):
    return re.search(pattern, (ROOT / file).read_text()).group(1)


def three(build):
    """three.js, if the build bundled it."""
    if not os.path.exists(os.path.join(build, "report", "view.js")):
        return set()
    folder = re.search(r"^RAYMOVAL_THREE:PATH=(.+)$", Path(build, "CMakeCache.txt").read_text(), re.M)
    return {folder.group(1) + "/three/build/three.module.js"}


def debian_package(name, facts):
    named = ", ".join(facts["licences"]) or "not machine-readable"
    return {"SPDXID": f"SPDXRef-{name.replace('+', '-plus')}", "name": name,
            "versionInfo": facts["version"], "supplier": "Organization: Debian",
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "homepage": facts["homepage"] or "NOASSERTION",
            "sourceInfo": f"built from Debian's source package {facts['source']}",
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION",
            "licenseComments": f"{copyright_file(name)} names: {named}",
            "copyrightText": "NOASSERTION",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}@{facts['version']}"
                                                  f"?arch={facts['architecture']}"}]}


def gather(build):
    """How each Debian package is used: linked, loaded (by what is linked), or compiled in."""
    binaries = [Path(build) / "raymoval", *sorted(Path(build).glob("python/raymoval/_raymoval*.so"))]
    uses = {}
    for binary in binaries:
        files, needed = loaded(str(binary))
        for file, package in packages_of(files).items():
            linked = os.path.basename(file) in needed
            if linked or package not in uses:
                uses[package] = "linked" if linked else "loaded"
    for package in packages_of(headers(build) | three(build)).values():
        uses.setdefault(package, "compiled in")
    return uses


def document(uses, facts, version, commit):
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    created = datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc)
    own = {"SPDXID": "SPDXRef-raymoval", "name": "raymoval", "versionInfo": version,
           "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "MIT",
           "licenseDeclared": "MIT", "copyrightText": "NOASSERTION",
           "sourceInfo": f"commit {commit}"}
    packages = [own] + [debian_package(name, facts[name]) for name in sorted(uses)]
    kinds = {"linked": "DYNAMIC_LINK", "loaded": "DEPENDS_ON", "compiled in": "CONTAINS"}
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", own["SPDXID"])]
    relations += [(own["SPDXID"], kinds[uses[package["name"]]], package["SPDXID"])
                  for package in packages[1:]]
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
            "name": f"raymoval-{version}",
            "documentNamespace": f"https://spdx.org/spdxdocs/raymoval-{version}-{commit}",
            "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"),
                             "creators": ["Tool: raymoval scripts/sbom.py"]},
            "packages": packages,
            "relationships": [{"spdxElementId": a, "relationshipType": kind,
                               "relatedSpdxElement": b} for a, kind, b in relations]}


def licence_list(uses, facts, version):
    lines = [f"# What raymoval {version} is linked with", "",
             "raymoval itself is under the MIT licence. Below are the Debian packages of the libraries",
             "that it links, of those that these load, and of headers and scripts that were compiled in,",
             "with the names of licences in Debian's copyright files. A package may name licences of",
             "parts that are not in its library; the file has the texts.", "",
             "| package | version | use | licences named |", "|---|---|---|---|"]
    order = {"linked": 0, "compiled in": 1, "loaded": 2}
    for name in sorted(uses, key=lambda name: (order[uses[name]], name)):
        named = ", ".join(facts[name]["licences"]) or f"see {copyright_file(name)}"
        lines.append(f"| {name} | {facts[name]['version']} | {uses[name]} | "
                     f"{named.replace('|', '/')} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(prog="sbom.py", description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("--json", required=True)
    parser.add_argument("--licences", required=True)
    parser.add_argument("--commit", default="unknown")
    given = parser.parse_args()
    build = os.path.abspath(given.build)
    if not os.path.exists(os.path.join(build, "raymoval")):
        sys.exit(f"sbom.py: {given.build}: no program raymoval there; expected a build folder")
    version = found_in("CMakeLists.txt", r"project\(raymoval VERSION (\S+)")
    uses = gather(build)
    facts = {name: facts_of(name) for name in uses}
    Path(given.json).write_text(json.dumps(
        document(uses, facts, version, given.commit), indent=1) + "\n")
    Path(given.licences).write_text(licence_list(uses, facts, version))


if __name__ == "__main__":
    main()
