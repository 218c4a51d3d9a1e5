#!/usr/bin/env python3
"""Copies the tables of numerical constants, changes the constants to variables and lists them, for campaign_constants.

    constants.py SIM OUT    SIM/<folder>/constants.hpp -> OUT/sim/<folder>/constants.hpp, OUT/constants.inc
"""
import pathlib
import re
import sys

# Constants that determine the layout of memory.
FIXED = {"kTangentMemories", "kMaxPieces"}

source, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
rows = []
for table in sorted(source.glob("*/constants.hpp")):
    folder = table.parent.name

    def variable(match):
        names = re.findall(r"\b(k[A-Z]\w*) =", match[2])
        if FIXED & set(names):
            return match[0]
        rows.extend(f'{{"{folder}", "{name}", &{name}}},' for name in names)
        return f"inline {match[1]} {match[2]};"

    text = re.sub(r"^inline constexpr (double|int|long|std::size_t) ([^;]*);", variable, table.read_text("utf-8"), flags=re.M)
    copy = out / "sim" / folder / "constants.hpp"
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text(text, "utf-8")
(out / "constants.inc").write_text("\n".join(rows) + "\n", "utf-8")
