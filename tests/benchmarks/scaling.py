#!/usr/bin/env python3
"""Cost of a continuation point against turns of wrap and against rod length: instructions, counted by valgrind.

    tests/benchmarks/scaling.py [--windlass build/release/windlass]

Twelve points of the flat Kirchhoff branch from T = 50 on the half chain, where even 16 turns are stable and no branch
point is located, index and error estimate included. (Cost against the number of elements: benchmark_arc_condensation.)
"""
import argparse, pathlib, tempfile
from compare_auto import ROOT, WALK, Windlass

CALLGRIND = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *WALK]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--windlass", default=ROOT / "build" / "release" / "windlass", type=pathlib.Path)
    options = parser.parse_args()
    tail = 12.0  # on each side, where only the wrap changes
    cases = [("turns", turns, 2 * turns, 6.2832 * turns + 2 * tail) for turns in (1, 2, 4, 8, 16)]
    cases += [("length", length, 2, length) for length in (30, 60, 120, 240)]
    print(f"{'':>8}{'':>6}{'M instr/point':>15}")
    with tempfile.TemporaryDirectory() as name:
        windlass = Windlass(options.windlass, pathlib.Path(name))
        for what, value, angle, length in cases:
            rows, _, counted = windlass.run("continue", "capstan-2pi.toml", {
                "model.kind": "kirchhoff", "load.angle": f"{angle} pi", "rod.length": length, "continuation.from": 50,
                "continuation.max_points": 12}, CALLGRIND)
            print(f"{what:>8}{value:>6}{counted / 1e6 / len(rows):>15.2f}")


if __name__ == "__main__":
    main()
