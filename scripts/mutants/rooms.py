# SPDX-License-Identifier: MIT
"""What is mutated, by which tests it is watched, and how much of it has to be found."""

import dataclasses
import fnmatch


@dataclasses.dataclass
class Room:
    patterns: tuple  # of files
    programs: tuple  # tests
    wanted: float  # percent of the mutants
    not_these: tuple = ()
    # Objects that are made with mutated headers; all that include one if it is empty. Some headers
    # are in nearly every object, and what only others see is not found: the score is a lower bound.
    headers_seen_by: tuple = ()


ROOMS = {
    "eval": Room(("eval/*",), ("test_eval",), 95),
    "readers": Room(("datasets/clouds/*", "datasets/reading/*", "datasets/*.cpp", "datasets/*.h",
                     "datasets/semantickitti/*", "datasets/dynamicmap/*", "datasets/files/*"),
                    ("test_datasets",), 95,
                    ("datasets/*/*/*", "datasets/simulation/*", "datasets/inspection/*",
                     "datasets/geometry/*", "datasets/ego/*", "datasets/world_axes/*",
                     "datasets/trajectories/*", "datasets/bags/*"),
                    headers_seen_by=("datasets/clouds/*", "datasets/reading/*", "datasets/ego/*",
                                     "datasets/semantickitti/*", "datasets/dynamicmap/*",
                                     "datasets/files/*", "datasets/layout*", "datasets/open*",
                                     "datasets/se*", "tests/datasets/c*", "tests/datasets/f*",
                                     "tests/datasets/l*", "tests/datasets/p*")),
    "stores": Room(("core/scan/mask_store.*", "core/scan/packed_mask.h", "core/files/file_writer.*",
                    "benchmark/run/folder/*", "benchmark/result/sealed_json.*",
                    "benchmark/result/cell*", "benchmark/result/record_fields.*",
                    "benchmark/result/run_record*", "benchmark/result/removals/*"),
                   ("test_core", "test_benchmark"), 95,
                   headers_seen_by=("core/scan/*", "core/files/*", "benchmark/result/*",
                                    "benchmark/run/*", "benchmark/process/mask_spool.cpp",
                                    "tests/core/mask*", "tests/core/file_writer*",
                                    "tests/benchmark/result/*", "tests/benchmark/run/*")),
    "raymoval": Room(("methods/raymoval/*",), ("test_methods",), 85, ("*-inl.h",)),
}


def fits(name, patterns):
    """Whether a file is one that the patterns mean."""
    return any(fnmatch.fnmatchcase(name, p) for p in patterns)


def files_of(room, tracked):
    """Sources and headers of a room among the `tracked` files."""
    return [name for name in tracked if name.endswith((".cpp", ".h")) and
            fits(name, room.patterns) and not fits(name, room.not_these)]
