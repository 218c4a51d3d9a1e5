#!/usr/bin/env python3
"""Ends runs of all kinds of outputs at random instants, and checks the remaining files.

kill_runs.py PROGRAM [--kills N] [--signals N] [--seed N]

Sends N SIGKILL and N other signals (SIGINT, SIGTERM, SIGHUP, one or two in a row), distributed over the kinds. After each:
  * every file under its final name has the bytes of an undisturbed run;
  * after a signal other than SIGKILL no other file remains, and the exit code is 130 (or the run had finished);
  * the next run does not replace a file that the user created under a missing name (exit code 6);
  * the next run without --force, an hour later, ends with 0 and leaves exactly the files of an undisturbed run;
  * every reference of a killed update is whole, the old or the new one, and the next update needs no --force.
"""
import argparse
import collections
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

TIME = '"time": {"end": 0.3}'
VIEW = '"size": [320, 180], "view": {"style": "flat"}'
OUTPUTS = {
    "still": '{"type": "still", "file": "a.png", "at": 0.2, "size": [1920, 1080], "view": {"style": "flat"}}',
    "frames": '{"type": "frames", "file": "a-###.png", "fps": 100, %s}' % VIEW,
    "video with poster": '{"type": "video", "file": "a.mp4", "fps": 120, "poster": 0.1, %s}' % VIEW,
    "gif": '{"type": "video", "file": "a.gif", "fps": 50, %s}' % VIEW,
    "webp": '{"type": "video", "file": "a.webp", "fps": 50, %s}' % VIEW,
    "figure pdf": '{"type": "figure", "file": "a.pdf", "figure": "angle"}',
    "figure svg": '{"type": "figure", "file": "a.svg", "figure": "angle"}',
    "figure png": '{"type": "figure", "file": "a.png", "figure": "angle"}',
    "csv": '{"type": "trajectory", "file": "a.csv", "rate": 20000}',
    "npz": '{"type": "trajectory", "file": "a.npz", "rate": 20000}',
    "json": '{"type": "impacts", "file": "a.json"}, {"type": "summary", "file": "b.json"}',
}
UPDATE = "baseline update"
BASELINES = """{"entries": {%s}}""" % ", ".join(
    '"e%d": {"scene": "s.json", "output": {"type": "frames", "from": 0.0%d, "to": 0.2, "fps": 60, %s}}' % (k, k, VIEW)
    for k in range(1, 4))


class Failure(Exception):
    pass


def require(condition, message):
    if not condition:
        raise Failure(message)


def digest(file):
    content = file.read_bytes()
    if file.name == "b.json":  # a summary tells how long its run took, and what it left undone
        content = repr(sorted(json.loads(content))).encode()
    return hashlib.sha256(content).hexdigest()


def files_in(folder):
    """Digests by name, without the list of files, which holds times."""
    return {str(p.relative_to(folder)): digest(p) for p in sorted(folder.rglob("*"))
            if p.is_file() and p.name != ".beamcam.jsonl"}


def pass_an_hour(folder):
    """What killed runs left half-written is removed when it is an hour old."""
    for part in folder.rglob(".*.part"):
        os.utime(part, (time.time() - 7200,) * 2)


class Campaign:
    def __init__(self, program, root, dice):
        self.program, self.root, self.dice = program, root, dice
        self.counts = collections.Counter()

    def start(self, arguments, folder):
        # A shell's background jobs ignore SIGINT, and their children inherit it.
        return subprocess.Popen([self.program, *map(str, arguments)], cwd=folder,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def run(self, arguments, folder, codes):
        process = self.start(arguments, folder)
        words = process.communicate()[0]
        require(process.returncode in codes, f"{arguments[0]}: exit code {process.returncode}, not {codes}: {words}")
        return words

    def end_somewhere(self, arguments, folder, duration, signals):
        """Runs until a random instant; returns the exit code."""
        process = self.start(arguments, folder)
        try:
            process.wait(timeout=self.dice.random() * duration * 1.05)
        except subprocess.TimeoutExpired:
            for number in signals:
                process.send_signal(number)
        process.communicate()
        code = process.returncode
        require(code in ([0, 7, -9] if signal.SIGKILL in signals else [0, 7, 130, 128 + 2, -2, -15, -1]),
                f"exit code {code} after {signals}")
        self.counts["ended early" if code not in (0, 7) else "finished before"] += 1
        return code

    # ---- outputs ---------------------------------------------------------------------------------

    def prepare(self, kind):
        folder = self.root / kind.replace(" ", "-")
        folder.mkdir()
        (folder / "s.json").write_text("{%s, \"outputs\": [%s]}" % (TIME, OUTPUTS[kind]))
        command = ["run", "s.json", "-q", "-j", "2", "-o"]
        self.run([*command, "right"], folder, [0])
        begin = time.monotonic()
        self.run([*command, "again"], folder, [0])
        return folder, command, time.monotonic() - begin, files_in(folder / "right")

    def try_output(self, prepared, signals):
        folder, command, duration, right = prepared
        out = folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        code = self.end_somewhere([*command, "out"], folder, duration, signals)
        made = files_in(out)
        for name, content in made.items():
            if name in right:
                require(content == right[name], f"{name} is not whole")
        others = sorted(set(made) - set(right))
        require(signal.SIGKILL in signals or len(signals) > 1 or not others, f"a polite signal left {others}")
        self.counts["left half-written"] += any(name.endswith(".part") for name in others)
        missing = sorted(set(right) - set(made))
        if missing and code not in (0, 7) and self.dice.random() < 0.5:
            own = out / self.dice.choice(missing)
            own.parent.mkdir(exist_ok=True)
            own.write_text("the user's own")
            self.run([*command, "out"], folder, [6])
            require(own.read_text() == "the user's own", f"{own} was overwritten")
            own.unlink()
            self.counts["user's files refused"] += 1
        pass_an_hour(out)
        self.run([*command, "out"], folder, [0])
        require(files_in(out) == right, f"the next run left {sorted(files_in(out))}")

    # ---- baselines -------------------------------------------------------------------------------

    def prepare_update(self):
        folder = self.root / "update"
        folder.mkdir()
        states = []
        for title in ("old", "new"):
            (folder / "s.json").write_text('{%s, "title": "%s"}' % (TIME, title))
            if title == "old":
                (folder / "b.json").write_text(BASELINES)
            begin = time.monotonic()
            self.update(folder)
            states.append(self.guarded(folder))
            if title == "old":
                shutil.copytree(folder, self.root / "update-old")
        return folder, time.monotonic() - begin, states

    def update(self, folder):
        self.run(["test", "b.json", "-q", "-j", "2", "--update", "e1", "e2", "e3"], folder, [7])

    @staticmethod
    def guarded(folder):
        return {name: content for name, content in files_in(folder).items() if name != "s.json"}

    def try_update(self, prepared, signals):
        folder, duration, (old, new) = prepared
        shutil.rmtree(folder)
        shutil.copytree(self.root / "update-old", folder)
        (folder / "b" / "e1" / "notes.txt").write_text("the user's own")
        (folder / "s.json").write_text('{%s, "title": "new"}' % TIME)
        self.end_somewhere(["test", "b.json", "-q", "-j", "2", "--update", "e1", "e2", "e3"], folder, duration, signals)
        state = self.guarded(folder)
        for name, content in state.items():
            if not name.endswith((".part", "notes.txt")):
                require(content in (old.get(name), new.get(name)), f"{name} is neither the old nor the new one")
        self.run(["test", "b.json", "-q"], folder, [0, 7])
        pass_an_hour(folder)
        self.run(["test", "b.json", "-q", "--update"], folder, [0, 7])
        self.run(["test", "b.json", "-q", "--strict"], folder, [0])
        require((folder / "b" / "e1" / "notes.txt").read_text() == "the user's own", "the user's notes are changed")
        left = [p.name for p in folder.rglob(".*.part")]
        require(not left, f"the next update left {left}")
        self.counts["updates ended early" if state != new else "updates complete"] += 1

    # ---- all -------------------------------------------------------------------------------------

    def go(self, kills, polite):
        prepared = {kind: self.prepare(kind) for kind in OUTPUTS}
        prepared[UPDATE] = self.prepare_update()
        kinds = list(prepared)
        trials = [(kinds[i % len(kinds)], [signal.SIGKILL]) for i in range(kills)]
        for i in range(polite):
            first = self.dice.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
            trials.append((kinds[i % len(kinds)], [first] * self.dice.choice([1, 1, 1, 2])))
        failed = 0
        for kind, signals in trials:
            self.counts[f"of {kind}"] += 1
            try:
                (self.try_update if kind == UPDATE else self.try_output)(prepared[kind], signals)
            except Failure as failure:
                failed += 1
                print(f"{kind}, {[s.name for s in signals]}: {failure}", flush=True)
        for what, count in self.counts.items():
            print(f"{what}: {count}")
        print(f"{kills} kills, {polite} polite signals, {failed} failures")
        return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=26)
    parser.add_argument("--signals", type=int, default=13)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as root:
        campaign = Campaign(os.path.abspath(arguments.program), pathlib.Path(root), random.Random(arguments.seed))
        sys.exit(1 if campaign.go(arguments.kills, arguments.signals) else 0)


main()
