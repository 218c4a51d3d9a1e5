#!/usr/bin/python3
"""What a film costs beside what its encoder alone costs.

film.py BEAMCAM [--frames N] [--sizes 1280x720,...] [--presets ultrafast,...] [--styles flat,lit,solid] [--rivals] [--png] [--repeat N] [--csv FILE]

For every size and preset the very frames of the film are encoded alone, by the ffmpeg program with the same settings
and the same bits, from memory; every other number is CPU or wall seconds as a ratio to that. Drawing (of it reading back
from OpenGL), conversion and encoding are summed over their threads and tell wall seconds: beside an encoder that has all
cores they wait. Larger sizes take fewer frames, as many pixels. Runs are interleaved, medians are shown, and the largest
peak. --png adds the same frames as PNG files, beside the encoder of the last preset.
"""
import argparse
import csv
import os
import platform
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

STAGES = ("motion", "drawing", "conversion", "encoding")
HERE = os.path.dirname(os.path.abspath(__file__))


class Cost:
    """CPU and wall seconds and the peak memory of one child process."""

    def __init__(self, command):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter()
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.said = child.stderr.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        self.wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        self.peak = usage.ru_maxrss / 1024  # [MiB]
        if child.returncode:
            sys.exit(f"{' '.join(command)}\nended with {child.returncode}:\n{self.said}")


def stages(said):
    """What -v tells of these stages [s of wall time, summed over threads]."""
    line = re.search(r"^time: .*$", said, re.M)
    found = {name: re.search(rf"\b{name} ([\d.]+) s", line[0]) if line else None for name in STAGES}
    return {name: float(match[1]) for name, match in found.items() if match}


def render(program, file, style, size, frames, preset, crf, fps=60):
    return [program, "run", os.path.join(HERE, "film.json"), "-o", os.path.dirname(file), "-v", "--force",
            "--progress", "none",
            "--set", f"time.end={frames / fps}", "--set", f'outputs=[{{"type":"video","file":"{os.path.basename(file)}",'
            f'"size":[{size[0]},{size[1]}],"fps":{fps},"crf":{crf},"preset":"{preset}","view":{{"style":"{style}"}}}}]']


def frames_of(program, folder, style, size, frames, fps=60):
    return [program, "run", os.path.join(HERE, "film.json"), "-o", folder, "-v", "--force", "--progress", "none",
            "--set", f"time.end={frames / fps}", "--set", f'outputs=[{{"type":"frames","file":"frame-####.png",'
            f'"size":[{size[0]},{size[1]}],"fps":{fps},"view":{{"style":"{style}"}}}}]']


def encode(raw, file, size, preset, fps=60):
    return ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "yuv420p", "-s", f"{size[0]}x{size[1]}",
            "-r", str(fps), "-i", raw, "-c:v", "libx264", "-crf", "18", "-preset", preset, "-threads", "4",
            "-x264-params", "cpu-independent=1", file]


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program")
    p.add_argument("--frames", type=int, default=600)
    p.add_argument("--sizes", default="1920x1080")
    p.add_argument("--presets", default="veryfast")
    p.add_argument("--styles", default="flat,lit,solid")
    p.add_argument("--repeat", type=int, default=3)
    p.add_argument("--rivals", action="store_true", help="matplotlib and pycairo too, where installed")
    p.add_argument("--png", action="store_true", help="frames as PNG files too")
    p.add_argument("--csv")
    args = p.parse_args()
    if not shutil.which("ffmpeg"):
        sys.exit("the encoder alone is measured with the ffmpeg program; install ffmpeg")

    room = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    rows = []
    with tempfile.TemporaryDirectory(dir=room) as folder:
        file, raw = os.path.join(folder, "film.mp4"), os.path.join(folder, "film.yuv")
        for size in [tuple(int(n) for n in s.split("x")) for s in args.sizes.split(",")]:
            frames = min(args.frames, max(1, int(args.frames * 1920 * 1080 / (size[0] * size[1]))))
            for style in args.styles.split(","):
                # Lossless, then decoded: exactly what the encoder is given.
                Cost(render(args.program, file, style, size, frames, "ultrafast", 0))
                Cost(["ffmpeg", "-loglevel", "error", "-y", "-i", file, "-f", "rawvideo", raw])
                for preset in args.presets.split(","):
                    alone, film = [], []
                    for _ in range(args.repeat):
                        alone.append(Cost(encode(raw, os.path.join(folder, "alone.mp4"), size, preset)))
                        film.append(Cost(render(args.program, file, style, size, frames, preset, 18)))
                    rows.append(row(f"beamcam {style}", size, frames, preset, film, alone))
                    show(rows[-1], len(rows) == 1)
                    if args.rivals and style == "flat":
                        for rival in rivals(args, folder, file, size, frames, preset, alone):
                            rows.append(rival)
                            show(rival, False)
                if args.png:
                    count = min(frames, 120)
                    costs = [Cost(frames_of(args.program, os.path.join(folder, "png"), style, size, count))
                             for _ in range(args.repeat)]
                    rows.append(row(f"PNG {style}", size, count, "-", costs, alone, frames))
                    show(rows[-1], False)
    if args.csv:
        with open(args.csv, "w", newline="") as f:
            f.write(f"# {machine()}\n")
            writer = csv.DictWriter(f, rows[0])
            writer.writeheader()
            writer.writerows(rows)


def row(name, size, frames, preset, film, alone, encoded=None):
    """`encoded`: frames that the encoder alone encoded, where that is another number."""
    part = frames / (encoded or frames)
    cpu = part * statistics.median(c.cpu for c in alone)
    wall = part * statistics.median(c.wall for c in alone)
    parts = [stages(c.said) for c in film]
    share = {k: statistics.median(s.get(k, 0) for s in parts) for k in STAGES}
    return {"film": name, "size": f"{size[0]}x{size[1]}", "preset": preset, "frames": frames,
            "cpu_ms_a_frame": round(1000 * statistics.median(c.cpu for c in film) / frames, 2), "encoder_cpu_s": round(cpu, 3), "encoder_wall_s": round(wall, 3),
            "cpu_ratio": round(statistics.median(c.cpu for c in film) / cpu, 3),
            "wall_ratio": round(statistics.median(c.wall for c in film) / wall, 3),
            **{k.replace(" ", "_") + "_ratio": round(v / cpu, 3) for k, v in share.items()},
            "peak_mib": round(max(c.peak for c in film))}


def rivals(args, folder, file, size, frames, preset, alone):
    motion = os.path.join(folder, "motion.csv")
    Cost([args.program, "simulate", os.path.join(HERE, "film.json"), "--set", f"time.end={(frames - 1) / 60}", "--rate", "60",
          "--channels", "theta,tip_deflection,contact_force,contact_x,cam_angle", "--trajectory", motion, "--force"])
    for name, module in (("pycairo", "cairo"), ("matplotlib", "matplotlib")):
        if subprocess.run([sys.executable, "-c", f"import {module}"], stderr=subprocess.DEVNULL).returncode:
            print(f"{name}: not installed (python3-{module})", file=sys.stderr)
            continue
        script = os.path.join(HERE, "rivals", f"film_{'cairo' if name == 'pycairo' else name}.py")
        cost = Cost([sys.executable, script, motion, file, str(size[0]), str(size[1]), "60", preset])
        yield row(name, size, frames, preset, [cost], alone)


def machine():
    model = platform.machine()
    try:
        with open("/proc/cpuinfo") as f:
            model = next(line.split(":")[1].strip() for line in f if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return f"{model}, {os.cpu_count()} cores, {platform.system()} {platform.release()}"


def show(entry, head):
    if head:
        print(f"# {machine()}")
        print(f"{'film':14} {'size':>10} {'preset':>10} {'frames':>6} {'encoder':>9} {'cpu':>6} {'wall':>6} {'cpu/frame':>9} "
              f"{'draw':>6} {'convert':>8} {'encode':>7} {'peak':>9}")
    print(f"{entry['film']:14} {entry['size']:>10} {entry['preset']:>10} {entry['frames']:6} {entry['encoder_cpu_s']:7.2f} s "
          f"{entry['cpu_ratio']:5.2f}x {entry['wall_ratio']:5.2f}x {entry['cpu_ms_a_frame']:6.1f} ms {entry['drawing_ratio']:5.2f}x "
          f"{entry['conversion_ratio']:7.2f}x {entry['encoding_ratio']:6.2f}x "
          f"{entry['peak_mib']:5} MiB", flush=True)


if __name__ == "__main__":
    main()
