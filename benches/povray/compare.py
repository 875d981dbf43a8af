#!/usr/bin/env python3
"""Times Ogee against Debian's povray on the same pictures: whole processes, in turn (A B A B …), pinned to one core each,
medians, and the ratio pair by pair. Prints a Markdown table; judges nothing.

usage: compare.py [--runs N] [--threads 1|2] [--only NAME,…] [--ogee PATH]
needs: povray on the path, and `cargo build --release`. Generated inputs and pictures go to target/povray."""
import argparse, os, resource, statistics, subprocess, sys, time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
WORK = os.path.join(ROOT, "target", "povray")

# name, width, height, povray's arguments, ogee's arguments, least ratio wanted, command
CASES = [
    ("trivial", 320, 240, [], [], 20, "render"),
    ("loop", 16, 16, [], [], 20, "check"),
    ("calls", 16, 16, [], [], 15, "check"),
    ("curve", 16, 16, [], [], 30, "check"),
    ("spheres", 640, 480, ["Declare=N=1000000"], ["--set", "n=1000000"], 5, "render"),
    ("flat", 640, 480, [], [], 1 / 1.5, "render"),
    ("flake", 800, 600, ["Declare=D=5"], ["--set", "levels=5"], 3, "render"),
    ("mesh", 1024, 768, [], [], 4, "render"),
    ("patches", 1024, 768, [], [], 3, "render"),
    ("iso", 640, 480, [], [], 3, "render"),
]


def run(command, pin):
    """(wall seconds, cpu seconds, peak MiB, exit code) of a command."""
    start = time.monotonic()
    child = subprocess.Popen(["taskset", "-c", pin] + command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd=WORK)
    said = child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    wall = time.monotonic() - start
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, child.returncode, said


def source(name, ending):
    generated = os.path.join(WORK, f"{name}.{ending}")
    return generated if name == "flat" else os.path.join(HERE, f"{name}.{ending}")


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--runs", type=int, default=5)
    ask.add_argument("--threads", type=int, default=1)
    ask.add_argument("--only", default="")
    ask.add_argument("--ogee", default=os.path.join(ROOT, "target", "release", "ogee"))
    args = ask.parse_args()
    os.makedirs(WORK, exist_ok=True)
    if not os.path.exists(os.path.join(WORK, "mesh.obj")):
        subprocess.run([sys.executable, os.path.join(HERE, "meshes.py"), WORK], check=True)
    pin = "0" if args.threads == 1 else "0,1"
    print("| scene | povray wall s | cpu | MiB | ogee wall s | cpu | MiB | ratio wall (min … max) | ratio cpu | wanted |\n|---|---|---|---|---|---|---|---|---|---|")
    for name, w, h, povray_args, ogee_args, wanted, command in CASES:
        if args.only and name not in args.only.split(","):
            continue
        scene = source(name, "scene")
        if name == "mesh":  # its OBJ stands beside a copy of the scene
            scene = os.path.join(WORK, "mesh.scene")
            with open(source(name, "scene")) as text, open(scene, "w") as copy:
                copy.write(text.read())
        peer = ["povray", "+I" + source(name, "pov"), "+L" + WORK, f"+O{WORK}/{name}.pov.png", f"+W{w}", f"+H{h}", "-D", "-A", "+FN8",
                f"+WT{args.threads}"] + povray_args
        ours = [args.ogee, command, scene] + (["--threads", str(args.threads), "-o", f"{WORK}/{name}.png", "--size", f"{w}x{h}"] + ogee_args
                                              if command == "render" else [])
        pairs = []
        for turn in range(args.runs + 1):
            a, b = run(peer, pin), run(ours, pin)
            if a[3] != 0 or (b[3] != 0 and command == "render"):
                sys.exit(f"{name}: povray exit {a[3]}, ogee exit {b[3]}\n{(a[4] if a[3] else b[4]).decode()[-2000:]}")
            if turn:  # the first pair warms the caches
                pairs.append((a, b))
        middle = lambda side, figure: statistics.median(p[side][figure] for p in pairs)
        ratios = [a[0] / b[0] for a, b in pairs]
        cpu = statistics.median(a[1] / b[1] for a, b in pairs)
        print(f"| {name} | {middle(0, 0):.3f} | {middle(0, 1):.3f} | {middle(0, 2):.0f} | {middle(1, 0):.3f} | {middle(1, 1):.3f} | {middle(1, 2):.0f} "
              f"| **{statistics.median(ratios):.1f}** ({min(ratios):.1f} … {max(ratios):.1f}) | {cpu:.1f} | ≥ {wanted:.2g} |", flush=True)


if __name__ == "__main__":
    main()
