#!/usr/bin/env python3
"""windlass beside AUTO-07p on the same branches, in one run: milliseconds a point at equal accuracy.

    tests/benchmarks/compare_auto.py [--windlass build/release/windlass] [--repeats 5] [--instructions]

Three branches: the flat 2 pi coil of length 30 (its tail is AUTO's problem, with the length that the contact arc leaves),
the clamped strut, and the strut with its ends turned by pi; then windlass' helical branches, which AUTO, without contact
logic, cannot follow. Errors are the largest along a branch, of R_tot or of the end force, against closed forms (elliptic
integrals), for the turned strut against windlass' own solutions at tolerance 1e-13. Each side runs a ladder of meshes or
tolerances; the ratio sets AUTO's cheapest mesh that reaches an error against windlass' cheapest run that does no worse.
Times are the solvers' own clocks (AUTO's "Total Time"; run.json's timings of continuation and stability, so that error
estimates and the index of every point are included), the least of the repeats, which are interleaved. With
--instructions, valgrind counts instructions instead, which a busy machine does not disturb: AUTO's whole process,
windlass' walk without the start of the process; the struts then end at a shortening of 0.2.
"""
import argparse, csv, json, math, os, pathlib, re, shutil, subprocess, sys, tempfile
from elliptic import clamped_thrust, coil_contact_force

ROOT = pathlib.Path(__file__).resolve().parents[2]
AUTO = pathlib.Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p"))
ENVIRONMENT = {**os.environ, "AUTO_DIR": str(AUTO), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
WALK = ["--toggle-collect=continuation::Walker::step()", "--toggle-collect=windlass::equilibrium::RodProblem::total_index*"]

COMMON = dict(IPS=4, NINT=0, ILP=0, ISP=0, JAC=1, NCOL=4, IAD=3, NMX=1000, NPR=0, IID=0, EPSL=1e-8, EPSU=1e-8,
              EPSS=1e-6, DSMIN=1e-5, IADS=1)
TAIL = dict(COMMON, NDIM=2, NBC=3, ICP=[1, 4, 5], DS=-0.05, DSMAX=0.05, UZSTOP={1: 0.55})
STRUT = dict(COMMON, NDIM=14, NBC=15, ICP=[1, 2, 4], DS=0.02, DSMAX=1.0, UZSTOP={1: 0.9})


class Auto:
    """Runs one equation file of this folder in a folder of its own."""

    def __init__(self, name, folder):
        self.folder, self.program = folder, folder / name
        source = ROOT / "tests" / "benchmarks" / "auto" / f"{name}.f90"
        compile = ["gfortran", "-O3", "-march=native", "-mno-avx512f", "-fopenmp", f"-J{folder}", str(source),
                   *map(str, sorted((AUTO / "lib").glob("*.o"))), "-o", str(self.program)]
        subprocess.run(compile, check=True)

    def run(self, constants, prefix=()):
        """Rows (AUTO's parameters by place), seconds, instructions or None."""
        text = "".join(f"{key} = {value}\n" for key, value in constants.items())
        (self.folder / "fort.2").write_text(text)
        done = subprocess.run([*prefix, str(self.program)], cwd=self.folder, env=ENVIRONMENT, capture_output=True,
                              text=True, check=True)
        rows = []
        for line in (self.folder / "fort.7").read_text().splitlines():
            if not line.startswith("   0"):
                numbers = [float(word) for word in line.split()[4:]]
                count = len(constants["ICP"])
                # parameter, norm, one maximum a state, the other parameters
                rows.append(dict(zip(constants["ICP"], numbers[:1] + numbers[len(numbers) - count + 1:])))
        if int(line.split()[2]) < -8:  # MX: no convergence
            sys.exit(f"AUTO did not converge: {constants}")
        return rows, float(re.search(r"Total Time\s+(\S+)", done.stdout)[1]), instructions(done)

    def keep_last(self):
        """The last labelled solution becomes the start of the next run; returns its label."""
        shutil.copy(self.folder / "fort.8", self.folder / "fort.3")
        return [int(line.split()[3]) for line in (self.folder / "fort.7").read_text().splitlines()
                if not line.startswith("   0")][-1]


def instructions(done):
    found = re.search(r"Collected\s*:\s*(\d+)", done.stderr)
    return int(found[1]) if found else None


class Windlass:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def call(self, *words, prefix=()):
        return subprocess.run([*prefix, str(self.program), *map(str, words)], env=ENVIRONMENT, capture_output=True,
                              text=True)

    def run(self, command, scene, settings, prefix=()):
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        out = self.folder / "run"
        done = self.call(command, ROOT / "data" / "scenes" / scene, *words, "--out", out, "--force", "--quiet",
                         "--no-eigenvalues",
                         prefix=prefix)
        if done.returncode not in (0, 2):
            sys.exit(done.stderr)
        with open(out / "branches.csv") as file:
            rows = list(csv.DictReader(file))
        timings = json.loads((out / "run.json").read_text())["timings"]
        return rows, timings["continuation"] + timings["stability"], instructions(done)

    def end_force(self, shortening, twist):
        done = self.call("solve", ROOT / "data/scenes/strut-twisted.toml", "--json", "--set", "model.tolerance=1e-13",
                         "--set", f"ends.shortening={shortening!r}", "--set", f"ends.twist={twist!r}")
        return json.loads(done.stdout)["end_force"]


def largest_error(pairs, reference):
    return max(abs(value / reference(at) - 1.0) for at, value in pairs)


def least(runs, counting):
    """One measurement a ladder rung from several: (points, milliseconds or millions of instructions a point)."""
    points = len(runs[0][0])
    return min((run[2] / 1e6 if counting else run[1] * 1e3) for run in runs) / points


def ladder(title, auto_rungs, windlass_rungs, unit):
    print(f"\n{title}\n  {'AUTO':<22}{'points':>7}{'error':>10}{unit:>14}")
    for name, points, error, cost in auto_rungs:
        print(f"  {name:<22}{points:>7}{error:>10.1e}{cost:>14.3f}")
    print(f"  {'windlass':<22}{'points':>7}{'error':>10}{unit:>14}")
    for name, points, error, cost in windlass_rungs:
        print(f"  {name:<22}{points:>7}{error:>10.1e}{cost:>14.3f}")
    for name, _, error, cost in auto_rungs:
        equal = [rung for rung in windlass_rungs if rung[2] <= error]
        if equal:
            best = min(equal, key=lambda rung: rung[3])
            print(f"  {name} against {best[0]}: windlass is {cost / best[3]:.1f} times faster a point")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--windlass", default=ROOT / "build" / "release" / "windlass", type=pathlib.Path)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--instructions", action="store_true", help="count instructions with valgrind")
    parser.add_argument("--cases", default="0,1,2,3", help="which of the four, by number")
    options = parser.parse_args()
    if not options.windlass.exists():
        sys.exit(f"{options.windlass}: not built (./windlass build)")
    with_auto = (AUTO / "lib" / "main.o").exists() and shutil.which("gfortran")
    if not with_auto:
        print("auto-07p or gfortran is not installed: windlass alone")
    counting = options.instructions
    repeats = 1 if counting else options.repeats
    unit = "M instr/point" if counting else "ms/point"
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"] if counting else []
    if counting:
        STRUT["UZSTOP"] = {1: 0.2}
    walk = [*valgrind, *WALK] if counting else []

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        windlass = Windlass(options.windlass, folder)
        turned = {}

        def turned_force(shortening):  # at a few points of a branch: each costs a process
            if shortening not in turned:
                turned[shortening] = windlass.end_force(shortening, math.pi)
            return turned[shortening]

        def some(rows):
            return [rows[len(rows) * k // 5] for k in range(1, 5)] + [rows[-1]]

        planar = {"model.kind": "planar", "continuation.to": 0.55, "continuation.step_max": 0.06}
        strut = {"continuation.step_max": 0.02, "continuation.step": 0.02,
                 "continuation.to": STRUT["UZSTOP"][1]}
        end = f"to {STRUT['UZSTOP'][1]}"
        cases = [
            ("flat 2 pi coil, T from 5 to 0.55, error of R_tot", "tail", TAIL, (20, 30, 50), 5,
             "capstan-2pi.toml", planar, ("T", "R_tot"), lambda T: coil_contact_force(T, 2 * math.pi, 15.0), list),
            (f"clamped strut, shortening from 0.01 {end}, error of the end force", "strut", STRUT, (20, 50), 4,
             "strut-clamped.toml", {**strut, "continuation.from": 0.01}, ("shortening", "end_force"), clamped_thrust,
             list),
            (f"the same, ends turned by pi, from 0.05 {end}", "strut", STRUT, (20, 50), 4, "strut-twisted.toml",
             {**strut, "continuation.from": 0.05}, ("shortening", "end_force"), turned_force, some),
        ]
        chosen = [int(word) for word in options.cases.split(",")]
        for title, equations, constants, meshes, output, scene, settings, columns, reference, choose in [
                cases[k] for k in chosen if k < len(cases)]:
            jobs = [(f"tolerance {t:g}", lambda t=t: windlass.run("continue", scene, {**settings, "model.tolerance": t}, walk))
                    for t in (1e-6, 2e-9, 1e-11)]
            ours = len(jobs)
            if with_auto:
                (folder / "auto").mkdir(exist_ok=True)
                auto = Auto(equations, folder / "auto")
                for n in meshes:
                    rung = {**constants, "NTST": n, "IRS": 0}
                    if scene == "strut-twisted.toml":
                        def job(rung=rung):
                            auto.run({**rung, "UZSTOP": {1: 0.05}})
                            auto.run({**rung, "IRS": auto.keep_last(), "ICP": [3, 2, 4], "UZSTOP": {3: math.pi}})
                            return auto.run({**rung, "IRS": auto.keep_last()}, valgrind)
                    else:
                        def job(rung=rung):
                            return auto.run(rung, valgrind)
                    jobs.append((f"NTST {n}, NCOL {constants['NCOL']}", job))
            runs = [[] for _ in jobs]
            for _ in range(repeats):
                for kept, (_, job) in zip(runs, jobs):
                    kept.append(job())
            rungs = []
            for k, ((name, _), kept) in enumerate(zip(jobs, runs)):
                rows = choose(kept[0][0][1:])  # AUTO's first row is the guess
                at, value = columns if k < ours else (1, output)
                error = largest_error([(float(row[at]), float(row[value])) for row in rows], reference)
                rungs.append((name, len(kept[0][0]), error, least(kept, counting)))
            ladder(title, rungs[ours:], rungs[:ours], unit)
        if len(cases) not in chosen:
            return
        helical = [windlass.run("diagram", "capstan-2pi.toml", {}, walk) for _ in range(repeats)]
        print(f"\ndiagram of the 2 pi coil, flat and helical, T from 5 to 0.1 (windlass alone)\n"
              f"  {len(helical[0][0])} points, {least(helical, counting):.3f} {unit}")


if __name__ == "__main__":
    main()
