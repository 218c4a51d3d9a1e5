#!/usr/bin/env python3
"""Damages the cache and the files of runs, and checks that all results are correct.

cache_torture.py PROGRAM [RUNS]

Makes RUNS runs (200) of a few requests of one motion, two at a time, in one directory with one cache. At random instants
it kills runs, damages, truncates, removes and redates entries of the cache, and replaces its directory by a file. Runs
that finish must write the bytes of an undisturbed run without a cache; runs that are killed must leave complete files or
none, and nothing that stops the next run.
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

SCENE = """{"time": {"end": %s}, "outputs": [
 {"type": "trajectory", "file": "%s.csv", "channels": ["theta", "gap", "contact_force"], "rate": 500},
 {"type": "impacts", "file": "%s-impacts.json"},
 {"type": "frames", "file": "%s-##.png", "size": [160, 90], "fps": 20, "view": {"style": "flat"}}]}"""
ENDS = ["0.2", "0.3", "0.45"]


def contents(folder, name):
    return {p.name: p.read_bytes() for p in sorted(folder.glob(name + "*"))
            if p.suffix in {".csv", ".png", ".json"} and p.stem != name}


def damage(cache, dice):
    """One mishap; returns its name."""
    entries = list(cache.glob("*.trajectory")) if cache.is_dir() else []
    kind = dice.choice(["flip", "cut", "remove", "future", "past", "file", "foreign", "nothing", "nothing", "nothing"])
    try:
        if kind == "file":
            shutil.rmtree(cache, ignore_errors=True)
            cache.write_text("not a directory")
        elif cache.is_file():
            cache.unlink()
        elif entries:
            entry = dice.choice(entries)
            if kind == "flip":
                with open(entry, "r+b") as out:
                    out.seek(dice.randrange(max(1, entry.stat().st_size)))
                    out.write(bytes([dice.randrange(256)]))
            elif kind == "cut":
                os.truncate(entry, dice.randrange(entry.stat().st_size))
            elif kind == "remove":
                entry.unlink()
            elif kind == "foreign":
                entry.write_text("something else")
            elif kind in ("future", "past"):
                at = time.time() + (1e8 if kind == "future" else -1e8)
                os.utime(entry, (at, at))
    except FileNotFoundError:
        pass  # the other run has just replaced it
    return kind


def main():
    program, runs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    dice = random.Random(1)
    with tempfile.TemporaryDirectory() as place:
        root = pathlib.Path(place)
        cache, out, right = root / "cache", root / "out", root / "right"
        environment = dict(os.environ, BEAMCAM_CACHE_DIR=str(cache))
        scenes = {}
        for k, end in enumerate(ENDS):
            name = "abc"[k]
            (root / f"{name}.json").write_text(SCENE % (end, name, name, name))
            subprocess.run([program, "run", "-q", "--no-cache", root / f"{name}.json", "-o", right], check=True,
                           env=environment)
            scenes[name] = contents(right, name)
        killed = finished = 0
        for round_number in range(runs // 2):
            damage(cache, dice)
            names = dice.sample(sorted(scenes), 2)
            started = []
            for name in names:
                for old in out.glob(name + "*"):
                    if dice.random() < 0.5:
                        old.unlink()
                started.append((name, subprocess.Popen([program, "run", "-q", root / f"{name}.json", "-o", out, "-j", "1"],
                                                       env=environment, stderr=subprocess.PIPE, text=True)))
            for name, process in started:
                if dice.random() < 0.5:
                    try:
                        process.wait(timeout=dice.random() * 0.25)
                    except subprocess.TimeoutExpired:
                        process.kill()
                        killed += 1
                error = process.communicate()[1]
                if process.returncode not in (0, -9):
                    sys.exit(f"round {round_number}, scene {name}: exit code {process.returncode}: {error}")
                finished += process.returncode == 0
                made = contents(out, name)
                for file, content in made.items():
                    if scenes[name].get(file) != content:
                        sys.exit(f"round {round_number}: {file} is wrong after {'a kill' if process.returncode else 'a run'}")
                if process.returncode == 0 and made != scenes[name]:
                    sys.exit(f"round {round_number}: scene {name} lacks {sorted(set(scenes[name]) - set(made))}")
        print(f"{2 * (runs // 2)} runs, {finished} finished, {killed} killed: all files correct")


main()
