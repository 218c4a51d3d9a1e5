#!/usr/bin/env python3
"""Gives commands a folder that came from somebody else, with hostile records in it, and checks that they write nowhere else.

hostile_records.py PROGRAM [--count N] [--seed N] [--jobs N] [--keep FOLDER]

The records are those that the program reads back: the list of files, references (PNG, CSV, JSON, digests), points of sweeps, and
tables (CSV, NPZ). Each case takes a folder that another user made, and changes one record: damaged bytes; forged entries of the list
of files with names, digests and sizes of other files, or copied marks; links in the place of a record, of a folder, or of an
output. Then it runs one or two commands. Every run must end within a minute with a documented exit
code, without a signal; and of all files beside the folder and in it, only those may change, appear or vanish that the
command announces: its outputs, the list of files, and references of the entries that --update names. Outputs that the user did not
make may not even change. N is 150 by default; cases that fail are stored in FOLDER.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

from damage import mutate, repair_npz, repair_png

DOCUMENTED = {0, 2, 3, 4, 5, 6, 7}  # 1 is a bug, 130 an interruption
LONGEST = 60  # [s]

STILL = '{"type": "still", "at": 0.1, "file": "p.png", "size": [64, 48], "view": {"style": "flat"}}'
SCENE = '{"title": "%s", "time": {"end": 0.2}, "outputs": [' + STILL + """,
 {"type": "frames", "file": "f-##.png", "fps": 20, "size": [64, 48], "view": {"style": "flat"}},
 {"type": "trajectory", "file": "t.csv", "channels": ["theta", "gap"], "rate": 100},
 {"type": "trajectory", "file": "t.npz", "channels": ["theta", "gap"], "rate": 100},
 {"type": "summary", "file": "s.json"}]}"""
OUTPUTS = {"p.png", "f-00.png", "f-01.png", "f-02.png", "f-03.png", "t.csv", "t.npz", "s.json"}
BASELINES = """{"references": "refs", "entries": {
 "still": {"scene": "own.json", "output": {"type": "still", "at": 0.1, "size": [64, 48], "view": {"style": "flat"}}},
 "frames": {"scene": "own.json", "output": {"type": "frames", "fps": 10, "size": [64, 48], "view": {"style": "flat"}}},
 "table": {"scene": "own.json", "output": {"type": "trajectory", "rate": 50, "channels": ["theta"]}},
 "sweep": {"scene": "swept.json", "output": {"type": "sweep"}}}}"""
ENTRIES = ["still", "frames", "table", "sweep"]
SWEPT = """{"beam": {"model": "rigid"}, "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
 "contact": {"model": "restitution", "law": "newton", "restitution": 0.5},
 "sweep": {"over": [{"key": "cam.speed", "values": [38, 40]}], "transient": {"cam_turns": 5}, "keep": {"cam_turns": 2}}}"""
REFERENCE = re.compile(r"\d{4,}\.png|(motion|impacts)(-\d+)?\.(csv|json)|sweep\.csv|digests\.json")

# Places outside of the folder that a hostile record wants.
WANTED = ["../victim/.profile", "../../victim/.profile", "../victim/new", "../victim", "{victim}/.profile", "{victim}/new"]
DIGEST = hashlib.sha256(b"precious").hexdigest()


def contents(root):
    """What is at each path: the bytes, the place that a link names, or a folder."""
    found = {}
    for path in root.rglob("*"):
        name = str(path.relative_to(root))
        found[name] = os.readlink(path) if path.is_symlink() else path.read_bytes() if path.is_file() else "folder"
    return found


class Case:
    def __init__(self, campaign, number, root):
        self.dice = random.Random(f"{campaign.seed} {number}")
        self.campaign, self.number, self.root = campaign, number, root
        self.place, self.victim = root / "place", root / "victim"
        shutil.copytree(campaign.samples, self.place, symlinks=True)
        self.victim.mkdir()
        for name in (".profile", "p.png", "film.mp4", "t.csv", "0000.png", "digests.json"):
            (self.victim / name).write_text("precious")

    def wanted(self):
        return self.dice.choice(WANTED).format(victim=self.victim)

    # ---- hostile records: each returns the words of the change ---------------------------------------

    def damage(self, path):
        data = mutate(path.read_bytes(), self.dice, path.suffix not in {".png", ".npz", ".points", ".part"})
        if self.dice.random() < 0.5:
            data = repair_png(data) if path.suffix == ".png" else repair_npz(data) if path.suffix == ".npz" else data
        path.unlink()
        path.write_bytes(data)
        return f"damaged {path.relative_to(self.place)}"

    def link(self, path):
        target = self.victim / self.dice.choice(["new", ".profile", path.name, ""])
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
        if self.dice.random() < 0.3 and target.is_file():
            os.link(target, path)
        else:
            path.symlink_to(target if self.dice.random() < 0.5 else os.path.relpath(target, path.parent))
        return f"link {path.relative_to(self.place)}"

    def forge(self):
        """Lines of the list of files for names inside and outside, with true and false digests."""
        file = self.place / ".beamcam.jsonl"
        lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
        made = self.dice.choice(lines)
        for _ in range(self.dice.choice([1, 3, 30])):
            name = self.dice.choice([self.wanted(), made["name"], "own.txt", ".profile", "..", ".", "", "a\0b", "x/../p.png", "\u202e"])
            line = {**made, "name": name, "sha256": self.dice.choice([DIGEST, made["sha256"], "", "0" * 64, "x" * 5000]),
                    "size": self.dice.choice([8, made["size"], -1, 1e300, "8", None, 2 ** 64]), "scene": "{" * 70}
            if self.dice.random() < 0.5:
                line["mark"] = self.dice.choice(["", "0" * 32, made.get("mark"), 3, []])
            lines.append(line)
        file.write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
        return "forged list of files"

    # ---- what is run, and what it announces -----------------------------------------------------------

    def choose(self):
        """The words of the change, the commands, and the names in the folder that may change."""
        kind = self.dice.choice(["list", "outputs", "references", "references", "update", "update", "points", "tables"])
        if kind in ("list", "outputs"):
            listed = kind == "list"
            words = self.dice.choice([self.forge, lambda: self.damage(self.place / ".beamcam.jsonl")])() if listed else \
                self.link(self.place / self.dice.choice(sorted(OUTPUTS) + [".beamcam.jsonl"]))
            commands = [["run", "own.json", "-o", ".", "-q"], ["run", "own.json", "-q"], ["run", "theirs.json", "-q"],
                        ["simulate", "own.json", "--trajectory", "new.csv", "-q"], ["info", "t.csv", "p.png"],
                        ["render", "own.json", "--at", "0", "--size", "64x48", "-o", "new.png", "-q"]]
            return words, self.dice.sample(commands, 2), {"new.csv", "new.png", ".beamcam.jsonl"}
        if kind in ("references", "update"):
            entry = self.dice.choice(ENTRIES)
            folder = self.place / "refs" / entry
            words = self.dice.choice([lambda: self.damage(self.dice.choice(sorted(folder.iterdir()))),
                                      lambda: self.damage(self.dice.choice(sorted(folder.iterdir()))),
                                      lambda: self.link(self.dice.choice([folder, folder.parent, *sorted(folder.iterdir())]))])()
            if kind == "references":
                return words, [["test", "b.json", "--filter", entry, "-q"], ["test", "b.json", "--json", "-q"]], set()
            return words, [["test", "b.json", "--update", entry, "-q"]], {f"refs/{entry}/"}
        if kind == "points":
            part = next(self.place.glob("r.1of2.*"))
            words = self.dice.choice([self.damage, self.damage, self.link])(part)
            if self.dice.random() < 0.5:  # as the points of an interrupted run
                os.rename(part, self.place / "r.csv.part")
                return words, [["sweep", "swept.json", "-o", "r.csv", "-q"]], {"r.csv", "r.csv.part", ".beamcam.jsonl"}
            parts = sorted(p.name for p in self.place.glob("r.*of2.*"))
            return words, [["collect", *parts, "-o", "r.csv", "-q"], ["info", part.name]], {"r.csv", ".beamcam.jsonl"}
        file = self.place / self.dice.choice(["t.csv", "t.npz"])
        words = self.damage(file)
        return words, [["info", file.name], ["diff", file.name, "other.csv"]], set()

    def is_announced(self, name, announced):
        inside = name.removeprefix("place/")
        if name == inside:
            return False
        return any(inside == a or (a.endswith("/") and inside.startswith(a) and REFERENCE.fullmatch(inside[len(a):]))
                   for a in announced)

    def run(self):
        words, commands, announced = self.choose()
        before = contents(self.root)
        for line in commands:
            try:
                done = subprocess.run([self.campaign.program, *line], cwd=self.place, env=self.campaign.environment("own"),
                                      capture_output=True, stdin=subprocess.DEVNULL, timeout=LONGEST)
            except subprocess.TimeoutExpired:
                return words, None, f"{words}: beamcam {' '.join(line)}: no end within {LONGEST} s"
            if done.returncode not in DOCUMENTED:
                text = done.stderr.decode("utf-8", "replace")[-300:]
                return words, done.returncode, f"{words}: beamcam {' '.join(line)}: exit {done.returncode}: {text}"
        after = contents(self.root)
        changed = sorted(n for n in before.keys() | after.keys() if before.get(n) != after.get(n) and not self.is_announced(n, announced))
        problem = f"{words}: {commands}: changed {changed}" if changed else None
        return words, done.returncode, problem


class Campaign:
    def __init__(self, args, root):
        self.program, self.seed, self.keep = os.path.abspath(args.program), args.seed, args.keep
        self.root, self.samples = root, root / "samples"

    def environment(self, user):
        return {**os.environ, "XDG_STATE_HOME": str(self.root / user), "TERM": "dumb"}

    def make_samples(self):
        self.samples.mkdir()
        for name, text in (("theirs.json", SCENE % "Theirs"), ("own.json", SCENE % "Own"), ("b.json", BASELINES), ("swept.json", SWEPT)):
            (self.samples / name).write_text(text, encoding="utf-8")
        for line in (["run", "theirs.json", "-q"], ["test", "b.json", "--update", "-q"],
                     ["simulate", "own.json", "--trajectory", "other.csv", "-q"],
                     ["sweep", "swept.json", "--shard", "1/2", "-o", "r.csv", "-q"],
                     ["sweep", "swept.json", "--shard", "2/2", "-o", "r.csv", "-q"]):
            done = subprocess.run([self.program, *line], cwd=self.samples, env=self.environment("them"), capture_output=True, text=True)
            if done.returncode not in (0, 7):
                sys.exit(f"making samples, {line}: exit {done.returncode}: {done.stderr}")

    def run(self, number):
        with tempfile.TemporaryDirectory(dir=self.root) as scratch:
            case = Case(self, number, pathlib.Path(scratch))
            words, code, problem = case.run()
            if problem and self.keep:
                shutil.copytree(scratch, os.path.join(self.keep, str(number)), symlinks=True, dirs_exist_ok=True)
            return words.split(" ")[0], code, problem and f"{number}: {problem}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep")
    args = parser.parse_args()
    kinds, codes, problems = collections.Counter(), collections.Counter(), []
    with tempfile.TemporaryDirectory() as scratch:
        campaign = Campaign(args, pathlib.Path(scratch))
        campaign.make_samples()
        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            for kind, code, problem in pool.map(campaign.run, range(args.count)):
                kinds[kind] += 1
                codes[code] += 1
                if problem:
                    problems.append(problem)
                    print(problem, file=sys.stderr, flush=True)
    print("kinds: " + ", ".join(f"{kind} {n}" for kind, n in sorted(kinds.items())))
    print("exit codes: " + ", ".join(f"{code}: {n}" for code, n in sorted(codes.items(), key=str)))
    print(f"{args.count} hostile records, {len(problems)} problems")
    sys.exit(1 if problems else 0)


main()
