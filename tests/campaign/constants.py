#!/usr/bin/env python3
"""Copies the sources of sim/ with their numerical constants as variables, for campaign_constants.

    constants.py SIM OUT    SIM/<folder>/<file> -> OUT/sim/<folder>/<file>
"""
import pathlib
import re
import sys

DECLARATION = re.compile(r"^(inline )?constexpr (double|int|long|std::size_t) (k[A-Z][^;{\[]*);", re.M)
NAME = re.compile(r"\b(k[A-Z]\w*)\s*=\s*")

source, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
files = {path: path.read_text("utf-8") for path in sorted(source.glob("*/*.[ch]pp"))}
everything = "\n".join(files.values())


# The sizes of arrays, arguments of templates and other constant expressions need constants.
def is_fixed(name):
    expressions = rf"\[[^\]\n]*\b{name}\b|<[^<>;&|\n]*\b{name}\b[^<>;&|\n]*>|\bconstexpr\b[^;]*=[^;]*\b{name}\b(?! =)"
    return re.search(expressions, everything)


def variable(file, match):
    names = NAME.findall(match[3])
    if any(is_fixed(name) for name in names):
        return match[0]
    values = [part.strip(" ,\n") for part in NAME.split(match[3])[1:]]
    lines = [f'{match[1] or "static "}{match[2]}& {name} = variable<{match[2]}>("{file}", "{name}", {value});'
             for name, value in zip(values[::2], values[1::2])]
    return " ".join(lines)


COEFFICIENTS = {"integrate/rk8_tableau.hpp"}  # of a published method

for path, text in files.items():
    name = path.relative_to(source).as_posix()
    copy = out / "sim" / name
    copy.parent.mkdir(parents=True, exist_ok=True)
    changed = text if name in COEFFICIENTS else DECLARATION.sub(lambda match: variable(name, match), text)
    if changed != text:
        changed = '#include "tests/campaign/variable.hpp"\n' + changed
    if not copy.exists() or copy.read_text("utf-8") != changed:
        copy.write_text(changed, "utf-8")
