#!/usr/bin/env python3
"""Proves that regression tests detect small changes: makes deliberate changes and runs `beamcam test` on each.

    mutations.py BEAMCAM            runs all changes, prints a table, fails if a verdict differs from the expected one
    mutations.py BEAMCAM --markdown the same table for tests/README.md

Changes of the mechanics and of the scene are made to the scene; changes of drawing are made to the reference picture (what was
expected), which is the same comparison seen from the other side. For each change: whether the digest sees it, the verdict of
an exact test (flat views), the verdict within two levels (lit views), and the verdict on the motion.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

BEAMCAM = os.path.abspath(sys.argv[1])
SIZE = [480, 270]
AT = 0.34  # after the first touch, on the way up


def entry(scene=None, at=AT, output=None):
    return {"scene": {"title": "A small change", "time": {"end": 0.6}, **(scene or {})},
            "output": output or {"type": "still", "at": at, "size": SIZE, "view": {"style": "flat"}}}


# ffmpeg filters on the reference. Sites in pixels of the picture: found once, kept in sight of the reference itself.
def pixel(x, y, change):
    return f"geq=r='if(eq(X,{x})*eq(Y,{y}),{change},r(X,Y))':g='g(X,Y)':b='b(X,Y)'"


def all_levels(step):
    return f"lutrgb=r='clip(val+{step},0,255)':g='clip(val+{step},0,255)':b='clip(val+{step},0,255)'"


def region(x, y, w, h, filters):
    return f"split[a][b];[b]crop={w}:{h}:{x}:{y},{filters}[c];[a][c]overlay={x}:{y}:format=rgb"


PAPER = "0xfdfdfb"
DRAWING = [  # name, filter, seen exactly, seen beyond two levels
    ("one pixel, one channel, one level", pixel(120, 60, "r(X,Y)-1"), True, False),
    ("one pixel, one channel, two levels", pixel(120, 60, "r(X,Y)-2"), True, False),
    ("one pixel, one channel, three levels", pixel(120, 60, "r(X,Y)-3"), True, True),
    ("one pixel turned black", "drawbox=x=120:y=60:w=1:h=1:color=black:t=fill", True, True),
    ("one pixel in the corner", "drawbox=x=479:y=269:w=1:h=1:color=black:t=fill", True, True),
    ("all colours one level darker", all_levels(-1), True, False),
    ("all colours two levels darker", all_levels(-2), True, False),
    ("all colours three levels darker", all_levels(-3), True, True),
    ("all colours five levels darker", all_levels(-5), True, True),
    ("all colours eight levels darker", all_levels(-8), True, True),
    ("red and blue exchanged", "colorchannelmixer=rr=0:rb=1:bb=0:br=1", True, True),
    ("drawing shifted by one pixel", "scroll=hpos=0.00208334", True, True),
    ("title in a larger face (2 %)", region(14, 12, 160, 26, "scale=163:26,crop=160:26:0:0"), True, True),
    ("label of the scale gone", "drawbox=x=418:y=207:w=45:h=12:color=%s:t=fill" % PAPER, True, True),
    ("a dot of the contact missing", "drawbox=x=202:y=152:w=4:h=4:color=0xc3c7d1:t=fill", True, True),
    ("outline of the beam wider", region(150, 72, 200, 100, "erosion=coordinates=2"), True, True),
    ("slightly blurred", "gblur=sigma=0.35", True, True),
    ("brightness by a gamma of 1.02", "eq=gamma=1.02", True, True),
    ("hues turned by two degrees", "hue=h=2", True, True),
    ("a row of pixels fewer", "crop=480:269:0:0", True, True),
    ("upside down", "vflip", True, True),
]

SHOWN = [  # name, scene, output: what is looked at, the motion stays
    ("one letter of the title", {"title": "A small chance"}, {}),
    ("deflection drawn 1 % larger", {}, {"view": {"style": "flat", "exaggeration": 5.05}}),
    ("colours for print", {}, {"theme": "print"}),
]

MECHANICS = [  # name, scene, motion verdict
    ("contact stiffness +0.1 %", {"contact": {"stiffness": 1.001e8}}, "different"),
    ("restitution 0.700 → 0.701", {"contact": {"restitution": 0.701}}, "different"),
    ("dissipation law exchanged", {"contact": {"damping": "flores"}}, "different"),
    ("contact exponent 1.500 → 1.501", {"contact": {"exponent": 1.501}}, "different"),
    ("friction 0 → 0.001", {"contact": {"friction": {"type": "coulomb", "coefficient": 0.001}}}, "different"),
    ("gravity 9.81 → 9.8101", {"gravity": 9.8101}, "different"),
    ("beam 0.1 mm longer", {"beam": {"length": 1.0001}}, "different"),
    ("stiffness of the beam +0.1 %", {"beam": {"youngs_modulus": 6.9020952e10}}, "different"),
    ("three modes for two", {"beam": {"modes": 3}}, "different"),
    ("cam 0.1 % faster", {"cam": {"speed": 1.001}}, "different"),
    ("cam 0.1 mm lower", {"cam": {"centre": [0.25, -0.0001]}}, "different"),
    ("first-order theory exchanged for zeroth", {"beam": {"model": "zeroth-order"}}, "different"),
    ("initial angle +1 µrad", {"initial": {"angle": 0.785399163397}}, "different"),
    ("damping ratio 0 → 0.0001", {"beam": {"damping_ratio": 0.0001}}, "different"),
    ("hub inertia 0 → 1e-5 kg m²", {"hub": {"inertia": 1e-5}}, "different"),
    ("contact offset 0 → 1 µm", {"contact": {"offset": 1e-6}}, "different"),
    ("solver's tolerance ten times tighter", {"solver": {"rtol": 1e-9, "atol": 1e-12}}, "equivalent"),
    ("another integrator, same tolerance", {"solver": {"method": "cvode-adams", "rtol": 1e-10, "atol": 1e-13}}, "equivalent"),
]


def sh(*args, **kw):
    return subprocess.run(args, capture_output=True, text=True, **kw)


def verdicts(folder):
    finished = sh(BEAMCAM, "test", "b.json", "--json", "-q", cwd=folder)
    if finished.returncode not in (0, 7):
        sys.exit(f"beamcam test ended with {finished.returncode}: {finished.stderr}")
    return json.loads(finished.stdout)["entries"]["e"], finished.returncode


def write(folder, baseline):
    (folder / "b.json").write_text(json.dumps({"entries": {"e": baseline}}), encoding="utf-8")


def accepted(folder, baseline):
    write(folder, baseline)
    sh(BEAMCAM, "test", "b.json", "--update", "e", "-q", cwd=folder)
    return baseline


def main():
    rows, wrong = [], []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        truth = accepted(folder, entry())
        picture = folder / "b/e/0000.png"
        original = picture.read_bytes()
        (folder / "b/e/digests.json").write_text("{}\n")  # of another machine: the pictures alone are compared

        def judge(name, baseline, exact, loose, motion):
            write(folder, {**baseline, "tolerance": {"channel": 2}})
            within, _ = verdicts(folder)
            write(folder, baseline)
            found, _ = verdicts(folder)
            same_digest = found["picture"]["verdict"] == "identical"
            changed = list(found["picture"]["changed"].values())
            numbers = changed[0].get("difference", {}) if changed else {}
            row = [name, "same" if same_digest else "other", found["picture"]["verdict"], within["picture"]["verdict"],
                   found["motion"]["verdict"], str(numbers.get("changed", 0)), str(numbers.get("largest", 0)),
                   f"{numbers.get('ssim', 1):.6f}"]
            rows.append(row)
            for what, is_, should in (("exact", found["picture"]["verdict"] == "different", exact),
                                      ("two levels", within["picture"]["verdict"] == "different", loose),
                                      ("motion", found["motion"]["verdict"], motion)):
                if should is not None and is_ != should:
                    wrong.append(f"{name}: {what} is {is_}, should be {should}")

        judge("nothing", truth, False, False, "identical")
        for name, filters, exact, loose in DRAWING:
            picture.write_bytes(original)
            made = sh("ffmpeg", "-v", "error", "-i", "e/0000.png", "-vf", filters + ",format=rgb24", "-y", "x.png", cwd=folder / "b")
            if made.returncode:
                sys.exit(f"{name}: {made.stderr}")
            os.replace(folder / "b/x.png", picture)
            judge(name, truth, exact, loose, "identical")
        picture.write_bytes(original)
        judge("one frame later (1/60 s)", {**truth, "output": {**truth["output"], "at": AT + 1 / 60}}, True, True, "identical")
        for name, scene, output in SHOWN:
            judge(name, {**truth, "scene": entry(scene)["scene"], "output": {**truth["output"], **output}}, True, True, "identical")
        for name, scene, motion in MECHANICS:
            judge(name, {**truth, "scene": entry(scene)["scene"]}, None, None, motion)

        # One impact lost: the table of expected impacts has one more than there is.
        impacts = folder / "b/e/impacts.json"
        listed = json.loads(impacts.read_text(encoding="utf-8"))
        listed["impacts"].append({**listed["impacts"][-1], "t_start": 0.33, "t_end": 0.3301})
        kept = impacts.read_text(encoding="utf-8")
        impacts.write_text(json.dumps(listed), encoding="utf-8")
        judge("one impact lost", truth, False, False, "different")
        impacts.write_text(kept, encoding="utf-8")

    heads = ["change", "digest", "exact", "within 2 levels", "motion", "pixels", "largest", "SSIM"]
    if "--markdown" in sys.argv:
        print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
        for row in rows:
            print("| " + " | ".join(row) + " |")
    else:
        widths = [max(len(row[i]) for row in rows + [heads]) for i in range(len(heads))]
        for row in [heads] + rows:
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    print(f"{len(rows)} changes", file=sys.stderr)
    if wrong:
        sys.exit("\n".join(wrong))


main()
