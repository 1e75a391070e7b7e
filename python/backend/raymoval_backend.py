# SPDX-License-Identifier: MIT
"""Builds the wheel of the package `raymoval` with CMake (PEP 517).

    pip install .                                       builds in build/wheel
    pip wheel . --config-settings=build=build/release   builds in a folder that is there already
"""
import base64
import hashlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def _cmake(*arguments):
    subprocess.run(["cmake", *map(str, arguments)], check=True, cwd=ROOT)


def _built(config_settings, prefix):
    """Builds the module and installs the package below `prefix`. Returns its folder."""
    build = (config_settings or {}).get("build")
    if build is None:
        build = "build/wheel"
        _cmake("-S", ".", "-B", build, "-G", "Ninja", "-DCMAKE_UNITY_BUILD=ON", "-DRAYMOVAL_PYTHON=ON",
               f"-DPython3_EXECUTABLE={sys.executable}", "-DRAYMOVAL_BUILD_TESTS=OFF",
               "-DRAYMOVAL_PYTHON_DIR=lib/python3/dist-packages")
    _cmake("--build", build, "--target", "raymoval_python")
    _cmake("--install", build, "--component", "python", "--prefix", prefix, "--strip")
    return next(Path(prefix).glob("**/raymoval/__init__.py")).parent


def _project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    found = re.search(r"project\(raymoval VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())
    return project, found.group(1)


def _metadata(project, version):
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
             f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}"]
    return "\n".join(lines + [f"Requires-Dist: {name}" for name in project["dependencies"]]) + "\n"


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    project, version = _project()
    folder = Path(metadata_directory) / f"raymoval-{version}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(_metadata(project, version))
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project, version = _project()
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    info = f"raymoval-{version}.dist-info"
    with tempfile.TemporaryDirectory() as prefix:
        package = _built(config_settings, prefix)
        files = {f"raymoval/{file.name}": file.read_bytes() for file in sorted(package.iterdir())}
    files[f"{info}/METADATA"] = _metadata(project, version).encode()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: raymoval_backend\n"
                              f"Root-Is-Purelib: false\nTag: {tag}\n").encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"raymoval-{version}-{tag}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content,
                             zipfile.ZIP_DEFLATED)
    return wheel
