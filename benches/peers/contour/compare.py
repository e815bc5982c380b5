"""Contours the same arrays with contourpy and with fgm-contour, in turns, and prints a table.

Usage: python compare.py OURS [ROUNDS], where OURS is the built program `contour-peers`. Needs numpy
and contourpy (see ../README.md).

Times are processor time of one thread, so that other programs lengthen them little, and the least
of all rounds, in nanoseconds a cell. contourpy runs its serial algorithm with each of the two kinds
of output that need no further work: separate lines (or separate polygons with their holes), and
one chunk with offsets; the faster counts. Its generator's construction is part of its time.
fgm-contour gives separate lines and polygons, with memory kept from the run before, as from layer
to layer; then lines without a copy, which are one chunk with offsets; then with new memory.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import contourpy
import numpy as np


def waves(n):
    """A smooth field with many closed lines."""
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    tau = 2 * np.pi
    coarse = np.sin(tau * (5 * x + 3 * y)) * np.cos(tau * (4 * x - 6 * y))
    return coarse + 0.5 * np.sin(tau * 11 * x) * np.sin(tau * 9 * y)


def hills(n):
    """One hill and one hollow."""
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    hill = np.exp(-((x - 0.3) ** 2 + (y - 0.4) ** 2) * 12)
    return hill - np.exp(-((x - 0.7) ** 2 + (y - 0.6) ** 2) * 9)


def noise(n):
    """Independent numbers: crossings in nearly every cell."""
    return np.random.default_rng(1).random((n, n))


KINDS = {
    "lines": ["Separate", "ChunkCombinedOffset"],
    "bands": ["OuterOffset", "ChunkCombinedOffsetOffset"],
}


def peer(values, kind, levels, output):
    """The seconds that contourpy takes."""
    begin = time.process_time()
    if kind == "lines":
        generator = contourpy.contour_generator(z=values, name="serial", line_type=output)
        for level in levels:
            generator.lines(level)
    else:
        generator = contourpy.contour_generator(z=values, name="serial", fill_type=output)
        for lower, upper in zip([-np.inf] + levels, levels + [np.inf]):
            generator.filled(lower, upper)
    return time.process_time() - begin


def ours(program, file, n, kind, levels):
    """The seconds that fgm-contour takes with kept memory, and with new memory."""
    arguments = [program, str(file), str(n), kind] + [repr(float(l)) for l in levels]
    told = subprocess.run(arguments, capture_output=True, text=True, check=True).stdout.split()
    return float(told[0]), float(told[1])


def row(program, rounds, file, values, kind, levels):
    """The least times, in nanoseconds a cell: contourpy's, then ours kept, in view, new."""
    n = len(values)
    theirs = kept = view = new = float("inf")
    for _ in range(rounds):
        for output in KINDS[kind]:
            theirs = min(theirs, peer(values, kind, levels, output))
        times = ours(program, file, n, kind, levels)
        kept, new = min(kept, times[0]), min(new, times[1])
        if kind == "lines":
            view = min(view, ours(program, file, n, "view", levels)[0])
    return [t * 1e9 / (n - 1) ** 2 for t in (theirs, kept, view, new)]


def compare(program, rounds):
    print(f"contourpy {contourpy.__version__}, numpy {np.__version__}; ns a cell\n")
    print("| data | size | task | contourpy | fgm-contour | ratio | without a copy | new memory |")
    print("|---|---|---|---|---|---|---|---|")
    for make in (hills, waves, noise):
        for n in (1024, 2048):
            values = make(n)
            low, high = float(values.min()), float(values.max())
            many = [low + (high - low) * (k + 1) / 16 for k in range(15)]
            tasks = [("1 level", "lines", many[7:8]), ("15 levels", "lines", many), ("16 bands", "bands", many)]
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "values"
                values.astype("<f8").tofile(file)
                for task, kind, levels in tasks:
                    theirs, kept, view, new = row(program, rounds, file, values, kind, levels)
                    shown = "" if kind == "bands" else f"{view:.2f}"
                    print(
                        f"| {make.__name__} | {n}² | {task} | {theirs:.1f} | {kept:.2f} "
                        f"| {theirs / kept:.1f} | {shown} | {new:.2f} |",
                        flush=True,
                    )


if __name__ == "__main__":
    compare(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5)
