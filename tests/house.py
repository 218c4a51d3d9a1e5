#!/usr/bin/env python3
"""Checks the structure of the source tree: the top-level entries, the order of includes, the use of libraries, that every
cited equation is in sim/MODEL.md, that every test named by a source or document exists, and that phrases are translated. Prints each violation as file:line and fails if there is one.

house.py ROOT            checks the tree
house.py --self-test     checks that the checks can fail
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TOP_LEVEL = {"CMakeLists.txt", "CMakePresets.json", "CHANGELOG.md", "LICENSE", "README.md",
             "sim", "render", "output", "scenes", "tests"}
IGNORED = {"build"}  # made by the build, never committed

# A top-level folder may include itself and those before it; so may its subfolders. Tests may include everything.
ROOMS = ["sim", "render", "output", "scenes"]

# Headers that only some files may include: the pattern, the number of .cpp files in each top-level folder.
PRIVATE_LIBRARIES = [
    ("SUNDIALS", re.compile(r"^(cvode|nvector|sunmatrix|sunlinsol|sunnonlinsol|sundials)/"), {"sim": 1}),
    ("OSMesa or EGL", re.compile(r"^(GL/osmesa\.h|EGL/)"), {"render": 2}),
    ("FFmpeg", re.compile(r"^(libav\w+|libsw\w+)/"), {"output": 4}),
    ("libnetcdf", re.compile(r"^netcdf"), {"output": 1}),
    ("HDF5", re.compile(r"^hdf5"), {"output": 1}),
    ("OpenSSL", re.compile(r"^openssl/"), {"output": 1}),
    ("libspng", re.compile(r"^spng\.h$"), {"output": 1}),
    ("nlohmann-json", re.compile(r"^nlohmann/"), {"output": 3}),
]
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
EQUATION = re.compile(r"\(S\d+[a-z]?\)")
TEST = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)
FOLDER = re.compile(r"`(\w+)/(\w+)`")
PHRASE = re.compile(r'\b(?:phrase\(\s*[\w.>-]+,|translate\()\s*"((?:[^"\\]|\\.)*)"')
TRANSLATION = re.compile(r'\{"((?:[^"\\]|\\.)*)",\s*"')
NAMED_TEST = re.compile(r"`(\w+\.[A-Z]\w*[a-z]\w*)`")


def sources(room):
    return sorted(p for p in room.rglob("*") if p.suffix in {".hpp", ".cpp", ".h"})


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if match := INCLUDE.match(line):
            yield number, match.group(1)


def top_level(root):
    """Committed entries where git knows them, so that a film made in the clone is no breach."""
    if (root / ".git").exists():
        listed = subprocess.run(["git", "-c", "safe.directory=*", "-C", str(root), "ls-files", "-z"],
                                capture_output=True, text=True)
        if listed.returncode == 0:
            return {name.split("/")[0] for name in listed.stdout.split("\0") if name}
    return set(os.listdir(root)) - IGNORED


def check_top_level(root):
    for name in sorted(top_level(root) - TOP_LEVEL):
        if not name.startswith("."):
            yield f"{name}: only {', '.join(sorted(TOP_LEVEL))} and dot-files may be at the top level"


def check_one_way(root):
    for rank, room in enumerate(ROOMS):
        for path in sources(root / room):
            for number, header in includes(path):
                target = header.split("/")[0]
                if target == "tests" or target in ROOMS[rank + 1:]:
                    yield f"{path.relative_to(root)}:{number}: {room} may not include {header}"
                if header.startswith("../") or header.startswith("./"):
                    yield f'{path.relative_to(root)}:{number}: include from the root, as "{room}/…"'


def folders(root):
    """The folders of each room in the order of tests/CONTRIBUTING.md, \"Where things are\": they include only those above them."""
    rows = [line for line in (root / "tests/CONTRIBUTING.md").read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    named = [folder for row in rows for folder in FOLDER.findall(row.split("|")[1])]
    return {room: [name for at, name in named if at == room] for room in ROOMS}


def folder_of(order, room, path):
    """The position of a file or header in the order of the folders of `room`; None: in none of them."""
    parts = str(path).split("/")
    inside = len(parts) > 2 and parts[0] == room and parts[1] in order[room]
    return order[room].index(parts[1]) if inside else None


def check_folders(root):
    order = folders(root)
    for room in ROOMS:
        for path in sources(root / room):
            name = path.relative_to(root)
            rank = folder_of(order, room, name)
            if rank is None:
                if len(name.parts) > 2:
                    yield f"{name}: tests/CONTRIBUTING.md does not list {room}/{name.parts[1]} under \"Where things are\""
                continue
            for number, header in includes(path):
                target = folder_of(order, room, header)
                if target is not None and target > rank:
                    yield f"{name}:{number}: {room}/{order[room][rank]} may not include {header}"
        for name in order[room]:
            if not (root / room / name).is_dir():
                yield f"tests/CONTRIBUTING.md: there is no folder {room}/{name}"


def check_private_libraries(root):
    for library, pattern, allowed in PRIVATE_LIBRARIES:
        for room in ROOMS:
            seeing = {}
            for path in sources(root / room):
                for number, header in includes(path):
                    if pattern.search(header):
                        seeing.setdefault(path, number)
            for path, number in seeing.items():
                if path.suffix != ".cpp":
                    yield f"{path.relative_to(root)}:{number}: {library} in a header; only .cpp files may include it"
            if len(seeing) > allowed.get(room, 0):
                for path, number in seeing.items():
                    yield (f"{path.relative_to(root)}:{number}: {library} is included by {len(seeing)} files of {room}; "
                           f"{allowed.get(room, 0)} are allowed")


def check_equations(root):
    model = root / "sim" / "MODEL.md"
    known = set(EQUATION.findall(model.read_text(encoding="utf-8"))) if model.exists() else set()
    for path in sources(root / "sim") + sources(root / "scenes"):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            for cited in EQUATION.findall(line):
                if cited not in known:
                    yield f"{path.relative_to(root)}:{number}: equation {cited} is not in sim/MODEL.md"


def check_named_tests(root):
    """`Suite.Name`, where Suite is one of the project's; files such as `sim/MODEL.md` have no such suite."""
    tests = [match for path in sources(root / "tests") for match in TEST.findall(path.read_text(encoding="utf-8"))]
    known, suites = {".".join(test) for test in tests}, {suite for suite, _ in tests}
    documents = [p for p in sorted(root.rglob("*.md")) if p.relative_to(root).parts[0] in TOP_LEVEL]
    for path in [p for room in ROOMS for p in sources(root / room)] + documents:
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            for name in NAMED_TEST.findall(line):
                if name.split(".")[0] in suites and name not in known:
                    yield f"{path.relative_to(root)}:{number}: no test is named {name}"


def check_phrases(root):
    table = root / "render/plot/lang.cpp"
    known = set(TRANSLATION.findall(table.read_text(encoding="utf-8"))) if table.exists() else set()
    for room in ("render", "scenes"):
        for path in sources(root / room):
            for phrase in PHRASE.findall(path.read_text(encoding="utf-8")):
                if phrase not in known:
                    yield f'{path.relative_to(root)}: render/plot/lang.cpp has no Chinese for "{phrase}"'


CHECKS = [check_top_level, check_one_way, check_folders, check_private_libraries, check_equations, check_named_tests, check_phrases]


def self_test():
    """Builds a small tree for each violation and expects that exactly the check for it finds it."""
    breaches = [
        ("notes.txt", "", check_top_level),
        ("sim/a.cpp", '#include "render/image.hpp"\n', check_one_way),
        ("render/a.hpp", '#include "output/png.hpp"\n', check_one_way),
        ("output/a.cpp", '#include "scenes/scene.hpp"\n', check_one_way),
        ("output/a.cpp", '#include "../sim/pose.hpp"\n', check_one_way),
        ("sim/beam/a.hpp", '#include "sim/run/simulate.hpp"\n', check_folders),
        ("scenes/other/a.cpp", "", check_folders),
        ("tests/CONTRIBUTING.md", "| `sim/beam` `sim/run` `sim/gone` | |\n", check_folders),
        ("sim/a.hpp", "#include <cvode/cvode.h>\n", check_private_libraries),
        ("render/a.cpp", "extern \"C\" {\n  #include <libavcodec/avcodec.h>\n}\n", check_private_libraries),
        ("sim/a.cpp", "#include <nlohmann/json.hpp>\n", check_private_libraries),
        ("sim/a.cpp", "// θ̈ (S99)\n", check_equations),
        ("scenes/a.cpp", '"`Modes.ArePrinted`"', check_named_tests),
        ("scenes/a.cpp", 'phrase(lang, "nowhere")', check_phrases),
    ]
    for name, text, guard in breaches:
        with tempfile.TemporaryDirectory() as directory:
            root = pathlib.Path(directory)
            for room in ROOMS + ["tests"]:
                (root / room).mkdir()
            (root / "tests/a.cpp").write_text("TEST(Modes, AreComputed) {}  // `Modes.AreComputed`\n", encoding="utf-8")
            (root / "sim/MODEL.md").write_text("(S1)", encoding="utf-8")
            (root / "tests/CONTRIBUTING.md").write_text("| `sim/beam` `sim/run` | |\n", encoding="utf-8")
            for folder in ("sim/beam", "sim/run"):
                (root / folder).mkdir()
            (root / "sim/solver.cpp").write_text("#include <cvode/cvode.h>  // (S1)\n", encoding="utf-8")
            if found := [breach for check in CHECKS for breach in check(root)]:
                sys.exit(f"a correct tree has violations: {found}")
            (root / name).parent.mkdir(exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
            for check in CHECKS:
                if bool(list(check(root))) != (check is guard):
                    sys.exit(f"{check.__name__} gives the wrong result for {name}: {text!r}")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    breaches = [breach for check in CHECKS for breach in check(root)]
    print("\n".join(breaches) or "the house is in order")
    sys.exit(1 if breaches else 0)


main()
