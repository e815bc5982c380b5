"""geos.py FILE [RUNS]: GEOS through shapely: noding and polygonizing, plain and on a grid of 1e-6 mm."""

import resource
import sys
import time
from pathlib import Path

import shapely


def main():
    file = Path(sys.argv[1])
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    # A grid needs as much memory again: `plain` or `grid` alone shows what each takes.
    kinds = sys.argv[3:] or ["plain", "grid"]
    rows = [[int(word) / 1e6 for word in line.split()] for line in file.open()]
    lines = shapely.multilinestrings([shapely.linestrings(row[::2], row[1::2]) for row in rows])
    if "plain" in kinds:
        report(file, runs, "plain", lambda: shapely.node(lines))
    if "grid" in kinds:
        report(file, runs, "1e-6 grid", lambda: shapely.unary_union(lines, grid_size=1e-6))


def report(file, runs, kind, node):
    least = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        noded = node()
        faces = shapely.polygonize([noded])
        least = min(least, time.perf_counter() - start)
    version = ".".join(map(str, shapely.geos_version))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6
    parts = shapely.get_parts(faces)
    print(
        f"{f'GEOS {version} {kind}':22} {file.stem:12} {least * 1e3:9.2f} ms {memory:6.0f} MB "
        f"{'-':>8} V {'-':>8} E {len(parts):8} F {shapely.area(parts).sum():.9f} mm2",
        flush=True,
    )


main()
