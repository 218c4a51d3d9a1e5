#!/usr/bin/env python3
"""Passes damaged files of all kinds to all commands that read them.

mutations.py PROGRAM [--count N] [--seed N] [--jobs N] [--keep FOLDER]

The program itself writes the samples: scenes, baselines, CSV and NPZ tables, PNG, PDF and SVG pictures, films in all
containers, the list of files of an output folder. Each run gets a sample with a few mutations: flipped bytes;
parts cut, doubled, exchanged, or overwritten with numbers, words and escape sequences. In half of the runs the checksums are
repaired, so that the code behind them is reached. Every run must end within a minute, with a documented exit code other
than 1 (bug), without a signal, and without control characters, directional marks and invalid UTF-8 on standard output and
standard error. N is 500 by default; inputs that fail are stored in FOLDER.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

from damage import mutate, repair_npz, repair_png

DOCUMENTED = {0, 2, 3, 4, 5, 6, 7}  # 1 is a bug, 130 an interruption
LONGEST = 60  # [s]
MOST_MEMORY = 6 << 30  # [bytes] of address space: a run that asks for more gets a message instead
UNSAFE = re.compile("[\0-\b\v-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\U000e0000-\U000e007f]")

FILM = '{"type": "video", "file": "f.%s", "size": [64, 48], "fps": 20, "view": {"style": "flat"}, "rate_mode": "constant"}'
SCENE = """{"title": "A sample", "time": {"end": 0.2}, "outputs": [
 {"type": "still", "at": 0.1, "file": "p.png", "size": [64, 48], "view": {"style": "flat"}},
 {"type": "trajectory", "file": "t.csv", "channels": ["theta", "gap"], "rate": 100},
 {"type": "trajectory", "file": "t.npz", "channels": ["theta", "gap"], "rate": 100},
 {"type": "impacts", "file": "i.json"}, {"type": "summary", "file": "s.json"},
 """ + ",\n ".join(FILM % e for e in ("mp4", "mkv", "webm", "gif", "webp", "mov")) + "]}"
RICH = """{"title": "Many keys", "hub": {"inertia": "2 kg m^2"}, "beam": {"length": "1 m", "modes": 3}, "gravity": 9.81,
 "cam": {"speed": "10 rpm"}, "contact": {"friction": {"type": "coulomb", "coefficient": 0.1}}, "time": {"end": "0.1 s"},
 "outputs": [{"type": "video", "file": "v.mp4", "size": [64, 48], "events": [{"at": "impact:1", "freeze": 0.1, "text": "x"}],
   "compare": [{"label": "a"}, {"label": "b", "set": {"beam.model": "rigid"}}, {"label": "c", "scene": "other.json"}],
   "layout": {"columns": ["mechanism", {"rows": ["theta", {"panel": "strip", "channels": ["gap"], "window": 0.1}]}]}},
  {"type": "frames", "file": "f-###.png", "size": [64, 48], "fps": 10, "speed": {"around": "impacts", "factor": 0.1}}]}"""
BASELINES = """{"tolerance": {"channel": 1}, "entries": {
 "still": {"scene": {"time": {"end": 0.2}}, "output": {"type": "still", "at": 0.1, "size": [64, 48], "view": {"style": "flat"}}},
 "other": {"scene": "other.json", "set": ["cam.speed=2"], "output": {"type": "trajectory", "rate": 50, "channels": ["theta"]}}}}"""

# kind: the sample file, and the commands that read it (with {f}); those of a scene get a short end.
SHORT = ["--set", "time.end=0.02"]
KINDS = {
    "scene": ("other.json rich.json scene.json", [
        ["check", "{f}"], ["check", "{f}"], ["plan", "{f}"], ["plan", "{f}", "--json"], ["run", "{f}", "-n", *SHORT],
        ["modes", "{f}"], ["figure", "{f}"], ["render", "{f}", "-o", "x.png", "--at", "0", "--size", "64x48", "-q", *SHORT],
        ["simulate", "{f}", "--impacts", "-", "-q", *SHORT]]),
    "baselines": ("b.json", [["test", "{f}", "-q"], ["test", "{f}", "--json"]]),
    "csv": ("t.csv", [["info", "{f}"], ["diff", "{f}", "t.csv"], ["diff", "t.csv", "{f}", "--json"]]),
    "npz": ("t.npz", [["info", "{f}"], ["diff", "{f}", "t.npz"], ["diff", "{f}", "t.csv", "--json"]]),
    "png": ("p.png", [["info", "{f}"], ["info", "{f}", "--json"], ["info", "{f}", "--scene"], ["diff", "{f}", "p.png"]]),
    "film": ("f.mp4 f.mkv f.webm f.mov", [["info", "{f}"], ["info", "{f}", "--json"]]),
    "list of files": (".beamcam.jsonl", [["run", "scene.json", "-q", "-n"], ["info", "t.csv"], ["info", "f.gif", "--json"], ["diff", "t.csv", "t.csv"]]),
}
TEXT = {"scene", "baselines", "csv", "list of files"}

class Campaign:
    def __init__(self, args, samples):
        self.program, self.samples, self.seed, self.keep = os.path.abspath(args.program), samples, args.seed, args.keep

    def environment(self, folder):
        return {**os.environ, "TERM": "dumb"}

    def run(self, number):
        dice = random.Random(f"{self.seed} {number}")
        kind = dice.choice(sorted(KINDS))
        names, commands = KINDS[kind]
        name, command = dice.choice(names.split()), dice.choice(commands)
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            for sample in self.samples.iterdir():
                if sample.is_file():
                    os.link(sample, folder / sample.name)
            if kind == "baselines":
                shutil.copytree(self.samples / "b", folder / "b")
            place = folder / name
            data = mutate(place.read_bytes(), dice, kind in TEXT)
            if dice.random() < 0.5:
                data = repair_png(data) if place.suffix == ".png" else repair_npz(data) if place.suffix == ".npz" else data
            if kind != "list of files":
                place = folder / ("x" + place.suffix)
            place.unlink(missing_ok=True)
            place.write_bytes(data)
            line = [part.format(f=place.name, e=place.suffix[1:]) for part in command]
            problem, code = self.problem(line, folder)
            if problem and self.keep:
                os.makedirs(self.keep, exist_ok=True)
                shutil.copy(place, os.path.join(self.keep, f"{number}-{place.name}"))
            return kind, " ".join(line), code, problem and f"{number}: {kind}: beamcam {' '.join(line)}: {problem}"

    def problem(self, line, folder):
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
        try:
            done = subprocess.run([self.program, *line], cwd=folder, env=self.environment(folder), capture_output=True,
                                  stdin=subprocess.DEVNULL, timeout=LONGEST, preexec_fn=limit)
        except subprocess.TimeoutExpired:
            return f"no end within {LONGEST} s", None
        if done.returncode not in DOCUMENTED:
            what = f"signal {-done.returncode}" if done.returncode < 0 else f"exit {done.returncode}"
            return f"{what}: {done.stderr.decode('utf-8', 'replace')[-300:]}", done.returncode
        for stream, text in (("standard output", done.stdout), ("standard error", done.stderr)):
            try:
                if found := UNSAFE.search(text.decode("utf-8")):
                    return f"{stream} has {found.group()!r}", done.returncode
            except UnicodeDecodeError as error:
                return f"{stream} is not UTF-8: {error}", done.returncode
        return None, done.returncode


def make_samples(program, folder):
    (folder / "scene.json").write_text(SCENE, encoding="utf-8")
    (folder / "rich.json").write_text(RICH, encoding="utf-8")
    (folder / "other.json").write_text('{"title": "Other", "time": {"end": 0.1}}', encoding="utf-8")
    (folder / "b.json").write_text(BASELINES, encoding="utf-8")
    for line, codes in ((["run", "scene.json", "-q"], {0}), (["simulate", "other.json", "--impacts", "-", "-q"], {0}),
                        (["test", "b.json", "--update", "still", "other", "-q"], {0, 7})):
        done = subprocess.run([program, *line], cwd=folder, capture_output=True, text=True)
        if done.returncode not in codes:
            sys.exit(f"making samples, {line}: exit {done.returncode}: {done.stderr}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep")
    args = parser.parse_args()
    counts, codes, problems = collections.Counter(), collections.Counter(), []
    with tempfile.TemporaryDirectory() as scratch:
        samples = pathlib.Path(scratch)
        make_samples(os.path.abspath(args.program), samples)
        campaign = Campaign(args, samples)
        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            for kind, _, code, problem in pool.map(campaign.run, range(args.count)):
                counts[kind] += 1
                codes[code] += 1
                if problem:
                    problems.append(problem)
                    print(problem, file=sys.stderr, flush=True)
    print("kinds: " + ", ".join(f"{kind} {n}" for kind, n in sorted(counts.items())))
    print("exit codes: " + ", ".join(f"{code}: {n}" for code, n in sorted(codes.items(), key=str)))
    print(f"{args.count} mutated inputs, {len(problems)} problems")
    sys.exit(1 if problems else 0)


main()
