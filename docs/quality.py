"""Slices the designs and measures the written G-code; prints the table of quality.md.

Usage: python docs/quality.py FGM [MODELS], where FGM is the built program and MODELS the folder with
3DBenchy.3mf; without it the Benchy is left out. Run it in the repository's root. Needs nothing but
Python.

Coverage, overlap, volume, composition, length and time are `fgm check`'s, which reads the G-code and
paints it in cells of 0.05 mm. Pieces are counted here: what is extruded between two travels or
changes of colour.
"""

import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Part, arguments, layers (all where left out).
SLAB = ("slab", ["designs/slab.vcad", "--infill", "100"], None)
BARE = ("slab, no towers", [*SLAB[1], "--purge", "off"], None)
PLATE = ("plate", ["designs/plate-y.vcad", "--infill", "100"], "5..8")
TUBE = ("tube", ["designs/tube.vcad", "--infill", "100"], "21..30")
DOGBONE = ("dog bone", ["designs/dogbone.vcad", "--infill", "100"], "3..6")
VASE = ("vase", ["designs/vase.vcad", "--walls", "10", "--infill", "0"], "201..210")
BENCHY = ["--fraction", "1/2 + 1/2 sin(2pi x/25) cos(2pi y/25) sin(2pi z/25)"]
PALETTES = [("sectioned", 8), ("sectioned", 16), ("against", 12), ("against", 24), ("against", 48)]

WORD = re.compile(r"([XYE])(-?[0-9.]+)")


def pieces(gcode):
    """How many pieces of the part there are, and how many are shorter than 5 mm."""
    count = short = 0
    length = 0.0
    x = y = 0.0
    role = ""

    def end():
        nonlocal count, short, length
        if length > 0.0 and role not in ("Wipe tower", "Skirt/Brim", "Skirt"):
            count += 1
            short += length < 5.0
        length = 0.0

    for line in gcode:
        if line.startswith(";TYPE:"):
            if length == 0.0 or "tower" in line or "tower" in role:
                end()
                role = line[6:].strip()
        elif line.startswith(";COLOR:"):
            end()
        elif line.startswith(("G0", "G1")):
            words = dict(WORD.findall(line.partition(";")[0]))
            to = float(words.get("X", x)), float(words.get("Y", y))
            step = math.dist((x, y), to)
            (x, y) = to
            if step > 0.0 and float(words.get("E", 0)) > 0.0:
                length += step
            elif step > 0.0:
                end()
    end()
    return count, short


def measure(fgm, part, strategy, colors, work):
    name, arguments, layers = part
    out, report, checked = work / "out.gcode", work / "report.json", work / "check.json"
    command = [fgm, "slice", *arguments, "-o", out, "--strategy", strategy, "--quiet"]
    command += ["--colors", str(colors), "--report", report]
    command += ["--layers", layers] if layers else []
    subprocess.run(command, check=True)
    design = [arguments[0]]
    if "--fraction" in arguments:
        design += ["--fraction", arguments[arguments.index("--fraction") + 1]]
    command = [fgm, "check", out, "--design", *design, "--cell", "0.05", "--json", checked]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    report, check = json.loads(report.read_text()), json.loads(checked.read_text())
    with open(out) as gcode:
        count, short = pieces(gcode)
    totals, coverage = check["totals"], check["coverage"]
    row = [
        name,
        strategy,
        str(colors),
        layers or "all",
        f"{100 * coverage['coverage']:.2f} %",
        f"{100 * coverage['overlap']:.2f} %",
        f"{100 * (totals['part_mm3'] / report['model_mm3'] - 1):+.2f} %",
        f"{100 * totals['travel_mm'] / totals['extrude_mm']:.1f} %",
        f"{100 * short / max(count, 1):.1f} %",
        f"{check['fidelity']['deposited']['mean']:.4f}",
        f"{totals['print_time_s'] / 3600:.2f} h",
    ]
    print("| " + " | ".join(row) + " |", flush=True)


def main():
    fgm = Path(sys.argv[1]).resolve()
    parts = [SLAB, PLATE, TUBE, DOGBONE]
    if len(sys.argv) > 2:
        benchy = Path(sys.argv[2]) / "3DBenchy.3mf"
        parts.append(("Benchy", [str(benchy), *BENCHY], "101..110"))
    parts.append(VASE)
    print(
        "| part | strategy | colours | layers | covered | laid twice | volume | travel | short "
        "pieces | composition off by | print time |"
    )
    print("|" + "---|" * 11)
    with tempfile.TemporaryDirectory() as work:
        for strategy, colors in PALETTES[:2]:
            measure(fgm, BARE, strategy, colors, Path(work))
        for part in parts:
            for strategy, colors in PALETTES:
                measure(fgm, part, strategy, colors, Path(work))


main()
