#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads files that other programs wrote, and has other programs read ours: a line for each.

    clouds.py PROGRAM    PROGRAM is raymoval_formats; scripts/formats.sh builds it

The others are NumPy, Python's struct, gzip and zipfile, PCL's converters (pcl-tools) and Open3D,
where they are there. Values are compared bit for bit, save LAS coordinates (half of their scale).
"""
import gzip
import os
import shutil
import struct
import subprocess
import sys
import tempfile

import numpy as np

from table import PROGRAM, Table, asked, made, same, structured

TABLE = Table()
say = TABLE.say


def read(path, layout=None):
    """What raymoval reads, as a structured array."""
    records = asked("dump", path, *([layout] if layout else []))
    return None if records is None else structured(records)


def convert(source, target, layout=None):
    return subprocess.run([PROGRAM, "convert", source, target] + ([layout] if layout else []),
                          check=False).returncode == 0


XYZ = [("x", "<f4"), ("y", "<f4"), ("z", "<f4")]
ALL = XYZ + [("a", "<f8"), ("b", "i1"), ("c", "<i2"), ("d", "<i4"), ("e", "u1"), ("f", "<u2"),
             ("g", "<u4"), ("intensity", "<f4")]
WIDE = [("t", "<u8"), ("s", "<i8")]
LAYOUTS = {"xyz float32": XYZ, "xyz float64": [(n, "<f8") for n, _ in XYZ],
           "xyz intensity": XYZ + [("intensity", "<f4")], "all types": ALL,
           "64-bit integers": ALL + WIDE, "ring and time": XYZ + [("ring", "<u2"), ("t", "<f8")],
           "several values": XYZ + [("normal", "<f4", (3,)), ("e", "u1", (2,))]}


def write_pcd(path, array, data):
    dtype = array.dtype
    counts = [int(np.prod(dtype[n].shape, dtype=int)) for n in dtype.names]
    kinds = {"f": "F", "i": "I", "u": "U"}
    head = "VERSION 0.7\nFIELDS " + " ".join(dtype.names)
    head += "\nSIZE " + " ".join(str(dtype[n].base.itemsize) for n in dtype.names)
    head += "\nTYPE " + " ".join(kinds[dtype[n].base.kind] for n in dtype.names)
    head += "\nCOUNT " + " ".join(map(str, counts))
    head += f"\nWIDTH {len(array)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(array)}"
    head += f"\nDATA {data}\n"
    with open(path, "wb") as file:
        file.write(head.encode())
        if data == "binary":
            file.write(array.tobytes())
            return
        for row in array:
            values = [repr(v.item()) for n in dtype.names for v in np.atleast_1d(row[n])]
            file.write((" ".join(values) + "\n").encode())


def write_ply(path, array, order):
    names = {"f4": "float", "f8": "double", "i1": "char", "i2": "short", "i4": "int",
             "u1": "uchar", "u2": "ushort", "u4": "uint"}
    head = "ply\nformat " + order + " 1.0\nelement before 1\nproperty list uchar int a\n"
    head += f"element vertex {len(array)}\n"
    for name in array.dtype.names:
        head += f"property {names[array.dtype[name].str[1:]]} {name}\n"
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    with open(path, "wb") as file:
        file.write(head.encode())
        if order == "ascii":
            file.write(b"2 7 8\n")
            for row in array:
                file.write((" ".join(repr(v.item()) for v in row) + "\n").encode())
            file.write(b"3 0 1 2\n")
            return
        sign = ">" if order == "binary_big_endian" else "<"
        file.write(struct.pack(sign + "Bii", 2, 7, 8))
        file.write(array.astype(array.dtype.newbyteorder(sign)).tobytes())
        file.write(struct.pack(sign + "Biii", 3, 0, 1, 2))


def read_ply(path):
    types = {"float": "<f4", "double": "<f8", "char": "i1", "short": "<i2", "int": "<i4",
             "uchar": "u1", "ushort": "<u2", "uint": "<u4"}
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    fields = [line.split() for line in head.decode().splitlines() if line.startswith("property")]
    stored = np.dtype([(name, types[kind]) for _, kind, name in fields])
    return np.frombuffer(body, stored)


def read_pcd(path):
    with open(path, "rb") as file:
        head, body = file.read().split(b"DATA binary\n", 1)
    entries = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines()
               if line and line[0] != "#"}
    dtype = np.dtype([(n, f"<{t.lower()}{s}", (int(c),)) if c != "1" else (n, f"<{t.lower()}{s}")
                      for n, t, s, c in zip(entries["FIELDS"], entries["TYPE"], entries["SIZE"],
                                            entries["COUNT"])])
    return np.frombuffer(body, dtype)


def try_text_formats(folder):
    for variant, fields in LAYOUTS.items():
        array = made(fields)
        for data in ("ascii", "binary"):
            path = f"{folder}/a.pcd"
            write_pcd(path, array, data)
            say("PCD " + data, variant, "Python", "read", same(read(path), array))
        convert(path, f"{folder}/b.pcd")
        say("PCD binary", variant, "Python", "written", same(read_pcd(f"{folder}/b.pcd"), array))
        if any(t[1] in ("<u8", "<i8") or len(t) > 2 for t in fields):
            continue
        for order in ("ascii", "binary_little_endian", "binary_big_endian"):
            path = f"{folder}/a.ply"
            write_ply(path, array, order)
            say("PLY " + order, variant, "Python", "read", same(read(path), array))
        convert(path, f"{folder}/b.ply")
        say("PLY binary", variant, "Python", "written", same(read_ply(f"{folder}/b.ply"), array))


def try_numpy(folder):
    for variant, fields in LAYOUTS.items():
        array = made(fields)
        for kind, dtype in (("fields", array.dtype), ("padded", np.dtype(fields, align=True)),
                            ("big-endian", array.dtype.newbyteorder(">"))):
            path = f"{folder}/a.npy"
            np.save(path, array.astype(dtype))
            say("npy " + kind, variant, "NumPy", "read", same(read(path), array))
        convert(path, f"{folder}/b.npy")
        say("npy fields", variant, "NumPy", "written", same(np.load(f"{folder}/b.npy"), array))
        np.savez(f"{folder}/a.npz", points=array, other=np.zeros(3))
        say("npz stored", variant, "NumPy", "read", same(read(f"{folder}/a.npz"), array))
        np.savez_compressed(f"{folder}/a.npz", array)
        say("npz deflated", variant, "NumPy", "read", same(read(f"{folder}/a.npz"), array))
    for kind in ("<f4", ">f8", "<i2", "|u1"):
        for order in "CF":
            plain = np.asarray(made([("v", kind, (5,))])["v"], order=order)
            np.save(f"{folder}/a.npy", plain)
            ours = read(f"{folder}/a.npy")
            equal = ours is not None and all(
                np.array_equal(ours[n], plain[:, i]) for i, n in enumerate(ours.dtype.names))
            say("npy numbers", f"{kind} {order}", "NumPy", "read", equal)
            convert(f"{folder}/a.npy", f"{folder}/b.npy")
            again = np.load(f"{folder}/b.npy")
            say("npy numbers", f"{kind} {order}", "NumPy", "written",
                again.shape == plain.shape and np.array_equal(again, plain))


def try_rows(folder):
    for count in (3, 4, 5, 6):
        names = ["x", "y", "z", "intensity", "ring", "t"][:count]
        array = made([(n, "<f4") for n in names])
        array.tofile(f"{folder}/a.bin")
        say("bin", f"{count} float32", "NumPy", "read",
            same(read(f"{folder}/a.bin", " ".join(names)), array))
    array = made(LAYOUTS["ring and time"])
    array.tofile(f"{folder}/a.bin")
    say("bin", "mixed types", "NumPy", "read", same(read(f"{folder}/a.bin", "x y z ring:u2 t:f8"),
                                                    array))
    for extension, layout in (("pcd", None), ("ply", None), ("npy", None),
                              ("bin", "x y z ring:u2 t:f8")):
        source = f"{folder}/c.{extension}"
        convert(f"{folder}/a.bin", source, "x y z ring:u2 t:f8")
        with open(source, "rb") as file, gzip.open(source + ".gz", "wb") as packed:
            packed.write(file.read())
        say("gzip", extension, "Python", "read", same(read(source + ".gz", layout), array))


def try_las(folder):
    """Files that struct makes after the specification; what a field becomes is checked by name."""
    sizes = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67]
    for point_format, minor in [(f, m) for f in range(11) for m in ([0, 2, 4] if f < 4 else [4])]:
        random = np.random.default_rng(point_format)
        rows = random.integers(0, 256, (20, sizes[point_format]), "u1")
        size = {4: 375, 3: 235}.get(minor, 227)
        head = bytearray(size)
        head[:4], head[24], head[25] = b"LASF", 1, minor
        struct.pack_into("<HIIBH", head, 94, size, size, 0, point_format, sizes[point_format])
        struct.pack_into("<I", head, 107, 20 if point_format < 6 else 0)
        struct.pack_into("<6d", head, 131, 0.01, 0.01, 0.01, 1, 2, 3)
        if minor == 4:
            struct.pack_into("<Q", head, 247, 20)
        path = f"{folder}/a.las"
        with open(path, "wb") as file:
            file.write(bytes(head) + rows.tobytes())
        ours = read(path)
        steps = rows[:, :12].copy().view("<i4")
        equal = ours is not None and all(
            np.array_equal(ours[n], steps[:, i] * 0.01 + i + 1) for i, n in enumerate("xyz"))
        equal = equal and np.array_equal(ours["intensity"], rows[:, 12:14].copy().view("<u2")[:, 0])
        gps = 22 if point_format >= 6 else 20
        if equal and "gps_time" in ours.dtype.names:
            equal = ours["gps_time"].tobytes() == rows[:, gps:gps + 8].tobytes()
        say("LAS 1." + str(minor), f"format {point_format}", "Python", "read", equal)
        convert(path, f"{folder}/b.las")
        again = read(f"{folder}/b.las")
        kept = again is not None and all(
            any(n in again.dtype.names and again[n].tobytes() == ours[name].tobytes()
                for n in (name, name + "_1")) for name in ours.dtype.names)
        say("LAS 1.4", f"from format {point_format} of 1.{minor}", "raymoval", "written", kept)


def try_pcl(folder):
    tool = shutil.which("pcl_convert_pcd_ascii_binary")
    for variant in ("xyz float32", "xyz intensity", "all types"):
        array = made(LAYOUTS[variant])
        write_pcd(f"{folder}/a.pcd", array, "binary")
        convert(f"{folder}/a.pcd", f"{folder}/ours.pcd")
        for number, data in enumerate(("ascii", "binary", "binary_compressed")):
            if tool is None:
                say("PCD " + data, variant, "PCL", "both", "no pcl-tools")
                continue
            path = f"{folder}/pcl.pcd"
            # 9 digits make float32 exact; float64 is exact in the binary forms.
            subprocess.run([tool, f"{folder}/ours.pcd", path, str(number), "17"],
                           capture_output=True, check=False)
            say("PCD " + data, variant, "PCL", "both", same(read(path), array))


def try_open3d(folder):
    try:
        import open3d  # pylint: disable=import-outside-toplevel
    except ImportError:
        say("PCD, PLY", "xyz", "Open3D", "both", "no python3-open3d")
        return
    array = made(LAYOUTS["xyz float64"])
    points = np.stack([array[n] for n in "xyz"], 1)
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    for extension, exact in (("pcd", "<f4"), ("ply", "<f8")):
        for ascii_form in (False, True):
            for compressed in (False, True) if extension == "pcd" and not ascii_form else (False,):
                path = f"{folder}/o.{extension}"
                open3d.io.write_point_cloud(path, cloud, write_ascii=ascii_form,
                                            compressed=compressed)
                ours = read(path)
                near = 1e-9 if ascii_form else 0
                equal = ours is not None and all(
                    np.all(np.abs(ours[n].astype("f8") - points[:, i].astype(
                        exact if not ascii_form else "f8")) <= max(near, 1e-4 * ascii_form))
                    for i, n in enumerate("xyz"))
                variant = "ascii" if ascii_form else "compressed" if compressed else "binary"
                say(extension.upper(), variant, "Open3D", "read", equal)
    for extension, variant in (("pcd", "xyz float32"), ("pcd", "xyz float64"),
                               ("ply", "xyz float32"), ("ply", "xyz float64")):
        array = made(LAYOUTS[variant])
        points = np.stack([array[n] for n in "xyz"], 1)
        np.save(f"{folder}/a.npy", array)
        convert(f"{folder}/a.npy", f"{folder}/r.{extension}")
        back = np.asarray(open3d.io.read_point_cloud(f"{folder}/r.{extension}").points)
        equal = np.array_equal(back, points)
        if not equal and extension == "pcd":
            # Open3D 0.16 takes binary numbers of 8 bytes for float32: so it does in a file of Python's.
            write_pcd(f"{folder}/p.pcd", array, "binary")
            other = np.asarray(open3d.io.read_point_cloud(f"{folder}/p.pcd").points)
            if np.array_equal(back, other):
                equal = "not read by Open3D, nor is Python's file"
        say(extension.upper(), variant, "Open3D", "written", equal)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for part in (try_text_formats, try_numpy, try_rows, try_las, try_pcl, try_open3d):
            part(folder)
    return TABLE.finish()


if __name__ == "__main__":
    os.environ["LC_ALL"] = "C"
    sys.exit(main())
