#!/usr/bin/env python3
"""Reads files of n and of 4 n parts and counts instructions (valgrind's callgrind). Without the cost of an empty file, four times
the parts may cost at most five times as much.

linear.py PROGRAM

Exit code 77 (skipped) without valgrind.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

N = 2000


def table(n):
    return ",".join(["t"] + [f"c{i}" for i in range(n)]) + "\n" + ",".join(["0"] * (n + 1)) + "\n"


def members(parts):
    return "{" + ",\n".join(parts) + "}"


def outputs(parts):
    return '{"outputs": [' + ",\n".join(parts) + "]}"


CASES = {  # name: (command, text of n parts)
    "keys": (["check", "{f}.json"], lambda n: members(f'"x-{i}": 1' for i in range(n))),
    "unknown keys": (["check", "{f}.json"], lambda n: members(f'"y{i}": 1' for i in range(n))),
    "duplicate keys": (["check", "{f}.json"], lambda n: members(f'"x-{i % (n // 2 + 1)}": 1' for i in range(n))),
    "duplicates of one key": (["check", "{f}.json"], lambda n: members('"x-a": 1' for _ in range(n))),
    "duplicates in one line": (["check", "{f}.json"], lambda n: members('"x-a": 1' for _ in range(n)).replace("\n", "")),
    "keys of an output": (["check", "{f}.json"], lambda n: outputs(['{"type": "summary", ' + ",".join(f'"x-{i}": 1' for i in range(n)) + "}"])),
    "changes of a comparison": (["check", "{f}.json"], lambda n: outputs(
        ['{"type": "still", "at": 0, "compare": [{}, {"set": {' + ",".join(f'"hub.x-{i}": 1' for i in range(n)) + "}}]}"])),
    "comparisons with a file": (["check", "{f}.json"], lambda n: outputs(
        f'{{"type": "still", "at": 0, "file": "s{i}.png", "compare": [{{}}, {{"scene": "x.json"}}]}}' for i in range(n // 10))),
    "outputs": (["check", "{f}.json"], lambda n: outputs(f'{{"type": "summary", "file": "s{i}.json"}}' for i in range(n))),
    "outputs in one line": (["check", "{f}.json"], lambda n: outputs(f'{{"type": "summary", "file": "s{i}.json"}}' for i in range(n)).replace("\n", "")),
    "outputs that clash": (["check", "{f}.json"], lambda n: outputs('{"type": "summary", "file": "s.json"}' for _ in range(n))),
    "sequences and files": (["check", "{f}.json"], lambda n: outputs(
        [f'{{"type": "frames", "file": "a{i}-##.png"}}' for i in range(n // 2)] +
        [f'{{"type": "still", "at": 0, "file": "b{i}-12.png"}}' for i in range(n // 2)])),
    "entries of baselines": (["test", "{f}.json", "--only", "none"], lambda n: '{"entries": {' + ",".join(
        f'"e{i}": {{"scene": {{}}, "output": {{"type": "still", "at": 0}}}}' for i in range(n // 10)) + "}}"),
    "columns of CSV": (["diff", "{f}.csv", "{f}.csv"], table),
    "columns that one table lacks": (["diff", "{f}.csv", "empty.csv"], table),
}


def instructions(program, folder, line):
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, *line], cwd=folder, text=True,
                          errors="replace", capture_output=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode not in (0, 2, 3, 7) or not found:
        sys.exit(f"{line}: exit {done.returncode}: {done.stderr[-1000:]}")
    return int(found.group(1))


def main():
    if not shutil.which("valgrind"):
        sys.exit(77)
    program, failed = os.path.abspath(sys.argv[1]), []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "empty.csv").write_text("t\n0\n", encoding="utf-8")
        for name, (line, text) in CASES.items():
            counts = []
            for n in (20, N, 4 * N):
                ending = re.search(r"\.\w+", line[1]).group()
                (folder / f"x{ending}").write_text(text(n), encoding="utf-8")
                counts.append(instructions(program, folder, [part.format(f="x") for part in line]))
            ratio = (counts[2] - counts[0]) / max(counts[1] - counts[0], 1)
            print(f"{name:32} {counts[1]:14} {counts[2]:14} {ratio:6.2f}", flush=True)
            if ratio > 5:
                failed.append(name)
    if failed:
        sys.exit("more than linear: " + ", ".join(failed))


main()
