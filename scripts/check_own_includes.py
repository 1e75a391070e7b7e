#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that every source file includes what it uses, itself or by what it includes: where several
files are compiled as one (RAYMOVAL_UNITY) the compiler does not notice a forgotten #include.

    check_own_includes.py [FOLDER]      of the repository, or of FOLDER

Names of this repository are looked up where their headers declare them, names of the standard
library and of other libraries in the tables below. It reads words, not C++: a name that a file
declares itself, or that any file which it includes mentions, is taken for that one."""

import pathlib
import re
import sys

ROOMS = ("core", "datasets", "methods", "eval", "benchmark", "python", "tests")
APART = ("tests", "benchmark/kernels")

# What the precompiled headers do not bring anyway, see cmake/rooms.cmake and tests/CMakeLists.txt.
STANDARD = {
    "atomic": "atomic atomic_bool atomic_flag atomic_ref memory_order_relaxed memory_order_acquire "
              "memory_order_release",
    "barrier": "barrier",
    "bit": "bit_cast bit_ceil bit_floor bit_width countl_zero countr_zero endian has_single_bit "
           "popcount rotl rotr",
    "bitset": "bitset",
    "charconv": "chars_format from_chars to_chars",
    "chrono": "chrono",
    "condition_variable": "condition_variable condition_variable_any",
    "csignal": "raise signal",
    "cstdlib": "abort exit getenv",
    "cstring": "memchr memcmp memcpy memmove memset strchr strcmp strerror strlen strncmp strstr",
    "ctime": "gmtime localtime mktime strftime",
    "deque": "deque",
    "exception": "current_exception exception_ptr rethrow_exception terminate uncaught_exceptions",
    "fstream": "filebuf fstream ifstream ofstream",
    "future": "async future packaged_task promise",
    "iomanip": "put_time setfill setprecision setw",
    "iostream": "cerr cin clog cout",
    "latch": "latch",
    "list": "list",
    "mutex": "call_once lock_guard mutex once_flag recursive_mutex scoped_lock unique_lock",
    "numbers": "numbers",
    "numeric": "accumulate adjacent_difference exclusive_scan gcd inclusive_scan inner_product "
               "iota lcm midpoint partial_sum reduce transform_reduce",
    "queue": "priority_queue queue",
    "random": "mt19937 mt19937_64 normal_distribution random_device uniform_int_distribution "
              "uniform_real_distribution",
    "regex": "regex regex_match regex_replace regex_search smatch",
    "shared_mutex": "shared_lock shared_mutex",
    "source_location": "source_location",
    "span": "as_bytes span",
    "sstream": "istringstream ostringstream stringstream",
    "stack": "stack",
    "stdexcept": "domain_error invalid_argument length_error logic_error out_of_range "
                 "overflow_error range_error runtime_error",
    "thread": "jthread this_thread thread",
    "typeindex": "type_index",
    "unordered_map": "unordered_map unordered_multimap",
    "unordered_set": "unordered_multiset unordered_set",
}
HEADERS_OF = {}
for header, names in STANDARD.items():
    for name in names.split():
        HEADERS_OF.setdefault(name, set()).add(header)
# Also from elsewhere, by the standard or by every standard library.
for header, brought in {"iostream": ("ostream", "istream"), "cstdlib": ("stdlib.h",),
                        "csignal": ("signal.h",), "cstring": ("string.h",), "ctime": ("time.h",),
                        "stdexcept": ("string", "filesystem", "array"),
                        "exception": ("stdexcept", "memory", "new")}.items():
    for name in STANDARD[header].split():
        HEADERS_OF[name].update(brought)

# Of the system, written as ::name.
SYSTEM = {
    "dirent.h": "closedir opendir readdir",
    "fcntl.h": "fcntl open openat",
    "fnmatch.h": "fnmatch",
    "poll.h": "poll",
    "semaphore.h": "sem_init sem_post sem_wait",
    "sys/file.h": "flock",
    "sys/ioctl.h": "ioctl",
    "sys/mman.h": "memfd_create mmap munmap",
    "sys/prctl.h": "prctl",
    "sys/resource.h": "getrlimit getrusage setrlimit",
    "sys/stat.h": "chmod fchmod fstat fstatat lstat mkdir stat",
    "sys/statvfs.h": "statvfs",
    "sys/vfs.h": "statfs",
    "sys/wait.h": "waitid waitpid",
    "unistd.h": "access chdir close close_range dup2 execve fchown fork fsync ftruncate geteuid "
                "gethostname getpid getppid isatty lchown link lseek pipe2 pread pwrite read "
                "setsid syscall sysconf unlink write",
    "zlib.h": "compress2 crc32 crc32_z inflate",
}
SYSTEM_HEADER_OF = {name: header for header, names in SYSTEM.items() for name in names.split()}

# How the headers of the libraries begin, by their namespaces.
LIBRARIES = {"fmt": "fmt/", "nlohmann": "nlohmann/", "tsl": "tsl/", "tbb": ("tbb/", "oneapi/"),
             "CLI": "CLI/", "hwy": "hwy/", "nanoflann": "nanoflann", "octomap": "octomap/",
             "pcl": "pcl/", "rc": "rapidcheck", "py": "pybind11/"}

BLANK = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'
                   r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", re.M)
TOKEN = re.compile(r"[A-Za-z_]\w*|::|->|[{}();=<>&*.,:\[\]~]|\d[\w.']*|\S")
WORD = re.compile(r"[A-Za-z_]\w*")
KEYWORDS = {"void", "bool", "char", "int", "float", "double", "auto", "const", "static", "inline"}
# Found by the types of what it is given, from a template that does not know them.
BY_ARGUMENT = {"describe"}
# Words that stand before a name that is used; any other word before it declares it.
BEFORE_USE = {"return", "throw", "new", "else", "case", "not", "and", "or", "in", "do", "goto",
              "typename", "public", "private", "protected", "friend", "const", "constexpr",
              "static", "inline", "mutable", "explicit", "virtual", "thread_local", "operator"}


class Source:
    """A file: what it includes, its words, and what it declares for others."""

    def __init__(self, text):
        self.includes = [(kind == '"', name) for kind, name in INCLUDE.findall(text)]
        text = BLANK.sub(lambda found: '""' if found.group()[0] in "\"R" else " ", text)
        self.macros = set(re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", text, re.M))
        self.words = set(WORD.findall(text))
        self.tokens = TOKEN.findall(DIRECTIVE.sub(" ", text))
        self.declared = self.macros | set(declarations(self.tokens)) - KEYWORDS - BY_ARGUMENT
        self.local = {token for i, token in enumerate(self.tokens) if is_local(self.tokens, i)}
        self.local |= enumerators(self.tokens)
        self.spaces = {name for i, name in enumerate(self.tokens)
                       if self.tokens[i - 1] == "namespace" and self.tokens[i + 1] != "="}


def declarations(tokens):
    """The names that are declared at namespace scope; forward declarations are left out."""
    statement, depth, spaces = [], 0, 0
    for token in tokens:
        if depth > 0:
            depth += {"{": 1, "}": -1}.get(token, 0)
            if depth == 0 and statement[:1] != ["="]:
                yield from declared_by(statement, True)
                statement = []
        elif token == "{":
            if "namespace" in statement[:2] or statement[:1] == ["extern"]:
                statement, spaces = [], spaces + 1
            else:
                depth = 1
        elif token == "}":
            statement = []
        elif token == ";":
            yield from declared_by(statement, False)
            statement = []
        else:
            statement.append(token)


def without_template(statement):
    if statement[:1] != ["template"]:
        return statement
    depth = 0
    for i, token in enumerate(statement):
        depth += {"<": 1, ">": -1}.get(token, 0)
        if token == ">" and depth == 0:
            return without_template(statement[i + 1:])
    return []


def declared_by(statement, has_body):
    statement = without_template(statement)
    words = [token for token in statement if WORD.fullmatch(token)]
    if not words:
        return
    if statement[0] in ("struct", "class", "union", "enum"):
        names = [word for word in words[1:] if word not in ("class", "struct", "alignas", "final")]
        if has_body and names:
            yield names[0]
    elif statement[0] == "using":
        if "=" in statement:
            yield words[1]
    elif statement[0] == "concept":
        yield words[1]
    elif "operator" not in statement:
        end = next((i for i, token in enumerate(statement) if token in ("(", "=")), len(statement))
        if end > 1 and statement[end - 2] != "::" and WORD.fullmatch(statement[end - 1]):
            yield statement[end - 1]


def enumerators(tokens):
    result, inside = set(), False
    for i, token in enumerate(tokens):
        if token == "enum":
            inside = True
        elif token in ("}", ";"):
            inside = False
        elif inside and tokens[i - 1] in ("{", ","):
            result.add(token)
    return result


def is_local(tokens, i):
    """Whether token `i` is declared there, or is a member's name."""
    before = tokens[i - 1] if i > 0 else ";"
    if before in (".", "->", "~"):
        return True
    if WORD.fullmatch(before):
        return before not in BEFORE_USE
    after = tokens[i + 1] if i + 1 < len(tokens) else ";"
    if after == "(":  # Of a function `Type& name(`, or an object `Type<Of> name(`.
        return before == ">" or before in ("&", "*") and (
            tokens[i - 2] == ">" or tokens[i - 2][0].isupper() or tokens[i - 3] == "::")
    return before in (">", "&", "*", ",", "[") and after in ("=", ";", ")", ",", ":", "]", "{")


def closures(sources):
    """For each file the files of the repository that it includes, and the others' names."""
    result = {}
    for start in sources:
        own, others, waiting = {start}, set(), [start]
        while waiting:
            for is_own, name in sources[waiting.pop()].includes:
                if not is_own or name not in sources:
                    others.add(name)
                elif name not in own:
                    own.add(name)
                    waiting.append(name)
        result[start] = own, others
    return result


def forgotten(path, sources, owners, spaces, closure):
    """Lines on names that `path` uses and does not include.

    owners: the headers of each name. spaces: the namespaces of this repository."""
    source, (own, others) = sources[path], closure
    tokens = source.tokens
    known = set().union(*(sources[file].words for file in own if file != path))
    known |= source.declared | source.local
    told = set()
    for i, token in enumerate(tokens):
        before = tokens[i - 1] if i > 0 else ""
        if before == "::" and i > 1 and tokens[i - 2] == "std":
            headers = HEADERS_OF.get(token)
            if headers and not headers & others:
                told.add(f"std::{token} needs <{' or '.join(sorted(headers))}>")
        elif before == "::" and token in SYSTEM_HEADER_OF and not WORD.match(tokens[i - 2]):
            if SYSTEM_HEADER_OF[token] not in others:
                told.add(f"::{token} needs <{SYSTEM_HEADER_OF[token]}>")
        elif token in LIBRARIES and tokens[i + 1:i + 2] == ["::"] and token not in source.spaces:
            if not any(name.startswith(LIBRARIES[token]) for name in others):
                told.add(f"{token}:: needs a header of that library")
        elif token in owners and token not in known:
            outside = before == "::" and tokens[i - 2] not in spaces
            is_call = i + 1 < len(tokens) and tokens[i + 1] == "("
            if not outside and (is_call or not token.islower()):
                told.add(f"{token} needs \"{' or '.join(sorted(owners[token]))}\"")
    return sorted(told)


def room_apart(path):
    return next((room for room in APART if path.startswith(room + "/")), "")


def main():
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    if len(sys.argv) > 2 or sys.argv[1:2] and sys.argv[1].startswith("-"):
        print(f"check_own_includes.py: '{sys.argv[-1]}' is unknown; expected a folder or nothing.",
              file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1]
    sources = {str(file.relative_to(root)): Source(file.read_text(encoding="utf-8"))
               for room in ROOMS for file in sorted((root / room).rglob("*"))
               if file.suffix in (".h", ".cpp")}
    # What tests and measurements of kernels declare is only for themselves.
    owners = {room: {} for room in ("", *APART)}
    for path, source in sources.items():
        if path.endswith(".h"):
            for name in source.declared:
                owners[room_apart(path)].setdefault(name, set()).add(path)
    for room in APART:
        owners[room] = {**owners[""], **owners[room]}
    spaces = set().union(*(source.spaces for source in sources.values()))
    found = 0
    for path, closure in closures(sources).items():
        for line in forgotten(path, sources, owners[room_apart(path)], spaces, closure):
            print(f"{path}: {line}", file=sys.stderr)
            found += 1
    print(f"check_own_includes.py: {len(sources)} files, {found} names without their header.")
    return found > 0


if __name__ == "__main__":
    sys.exit(main())
