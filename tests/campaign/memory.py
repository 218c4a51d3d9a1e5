#!/usr/bin/env python3
"""Runs all kinds of outputs with less and less memory (ulimit -v). Each run must succeed or end with a message about memory and
a documented exit code, without a signal, an endless loop or an incomplete file. Finished frames may remain: the next run resumes.

memory.py PROGRAM [--steps MB,MB,…]
"""
import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

DOCUMENTED = {0, 3, 5, 6}
STEPS = [20, 40, 60, 80, 100, 115, 130, 160, 200, 250, 300, 330, 360, 400, 500, 600, 700, 800, 1000, 1500, 2000]  # [MB]
LONGEST = 120  # [s]
NOTES = re.compile(r"\.beamcam\.jsonl")  # the list of files
FRAME, END_OF_PNG = re.compile(r"a-\d\d\.png"), b"IEND\xaeB`\x82"
SIZE = '"size": [1280, 720]'
FLAT, LIT, SOLID = ('"view": {"style": "%s"}' % style for style in ("flat", "lit", "solid"))
OUTPUTS = {
    "flat still": f'{{"type": "still", "at": 0.1, "file": "a.png", {SIZE}, {FLAT}}}',
    "large still": f'{{"type": "still", "at": 0.1, "file": "a.png", "size": [4096, 4096], {FLAT}}}',
    "lit still": f'{{"type": "still", "at": 0.1, "file": "a.png", {SIZE}, {LIT}}}',
    "solid still": f'{{"type": "still", "at": 0.1, "file": "a.png", {SIZE}, {SOLID}}}',
    "frames": f'{{"type": "frames", "file": "a-##.png", "fps": 20, {SIZE}, {FLAT}}}',
    "figure PDF": '{"type": "figure", "figure": "schematic", "file": "a.pdf"}',
    "figure PNG": '{"type": "figure", "figure": "angle", "file": "a.png"}',
    "CSV": '{"type": "trajectory", "file": "a.csv", "rate": 1000, "channels": ["theta"]}',
    "NPZ": '{"type": "trajectory", "file": "a.npz", "rate": 1000, "channels": ["theta"]}',
    "impacts": '{"type": "impacts", "file": "a.json"}',
    "summary": '{"type": "summary", "file": "a.json"}',
    **{f"film {e} {c}": f'{{"type": "video", "file": "a.{e}", "codec": "{c}", "fps": 10, {SIZE}, {FLAT}}}'
       for e, c in (("mp4", "h264"), ("webm", "vp9"), ("mov", "prores"), ("mkv", "ffv1"), ("gif", "gif"),
                    ("webp", "webp"))},
    "lit film": f'{{"type": "video", "file": "a.mp4", "fps": 10, {SIZE}, {LIT}}}',
}


def run(program, folder, megabytes=None):
    """beamcam run s.json, with a limited address space."""
    def limit():
        if megabytes:
            resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))
    return subprocess.run([program, "run", "s.json", "-o", "out", "-q"], cwd=folder, capture_output=True, text=True,
                          errors="replace", timeout=LONGEST,
                          preexec_fn=limit)


def is_finished_frame(file):
    return FRAME.fullmatch(file.name) and file.read_bytes().endswith(END_OF_PNG)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--steps", default=",".join(map(str, STEPS)))
    args = parser.parse_args()
    program, problems = os.path.abspath(args.program), []
    for name, output in OUTPUTS.items():
        row = []
        for megabytes in map(int, args.steps.split(",")):
            with tempfile.TemporaryDirectory() as scratch:
                folder = pathlib.Path(scratch)
                (folder / "s.json").write_text(f'{{"time": {{"end": 0.3}}, "outputs": [{output}]}}', encoding="utf-8")
                try:
                    done = run(program, folder, megabytes)
                except subprocess.TimeoutExpired:
                    row.append("…")
                    problems.append(f"{name} with {megabytes} MB: no end within {LONGEST} s")
                    continue
                kept = [p for p in folder.glob("out/*") if done.returncode and not NOTES.fullmatch(p.name)]
                left = [p.name for p in kept if not is_finished_frame(p)]
                if kept and (again := run(program, folder)).returncode:
                    problems.append(f"{name} with {megabytes} MB: not resumed: {again.stderr[-300:]}")
                loader = done.returncode == 127  # the program itself does not fit
                row.append("-" if loader else str(done.returncode))
                if not loader and (done.returncode not in DOCUMENTED or left or (done.returncode and "memory" not in done.stderr)):
                    problems.append(f"{name} with {megabytes} MB: exit {done.returncode}, left {left}: {done.stderr[-300:]}")
        print(f"{name:16} {' '.join(code.rjust(3) for code in row)}", flush=True)
    print("\n".join(problems) or "every run succeeded or ended with a message")
    sys.exit(1 if problems else 0)


main()
