#!/usr/bin/env python3
"""Times Ogee's rays through meshes beside Embree 3's: one thread and one ray at a time, camera rays sixteen at a time besides, the same f32 rays, in turn chunk by chunk,
so that whatever else the machine does is the same for both. Prints millions of rays a CPU second (of each chunk the fastest round)
and their ratio; then in how many rays the two differ, and which of them a test of every triangle in f64 agrees with. Judges no speed.

usage: compare.py [--only A,B,…] [--sets primary,…] [--side N] [--rounds N] [--robust] [--small-pages] [--ogee PATH[:TREE]]…
       `--ogee` may stand several times, to compare builds, or trees as the report of trees names them: `--ogee target/release/ogee:kdtree`.
needs: Debian's libembree-dev (3.x), gcc, numpy, and `cargo build --release`. What is made goes to target/embree."""
import argparse, os, subprocess, time
import numpy as np
import meshes

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
WORK = os.path.join(ROOT, "target", "embree")
SETS = ["primary", "together", "shadow", "bounce", "shuffled"]
# What is asked of each; the rays that are asked together are the primary ones.
ORDERS = {"together": "together", "shadow": "any"}
CHUNK = 1 << 16
MOST_JUDGED = 300


class Peer:
    """A program that obeys the orders of `ogee bench rays` on its standard input."""

    def __init__(self, name, command):
        self.name = name
        pin = lambda: os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
        self.child = subprocess.Popen(command, cwd=WORK, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, preexec_fn=pin)
        # The clock of all CPU time of a process, as `clock_getcpuclockid` makes it.
        self.clock = (~self.child.pid << 3) | 2

    def order(self, *words):
        self.child.stdin.write(" ".join(map(str, words)) + "\n")
        self.child.stdin.flush()
        said = self.child.stdout.readline()
        if not said:
            raise SystemExit(f"{self.name} ended at: {' '.join(map(str, words))}")
        return said.split()

    def timed(self, *words):
        """CPU seconds of an order, and what was said."""
        before = time.clock_gettime(self.clock)
        said = self.order(*words)
        return time.clock_gettime(self.clock) - before, said

    def answers(self, file):
        out = f"{self.name.replace(' ', '-').replace('/', '-')}.answers"
        self.order("answers", file, out)
        found = np.fromfile(os.path.join(WORK, out), np.uint32)
        return out, found[: len(found) // 2], found[len(found) // 2 :].view(np.float32)

    def end(self):
        self.child.stdin.close()
        self.child.wait()


def compiled():
    program = os.path.join(WORK, "rays")
    subprocess.run(["gcc", "-O2", "-o", program, os.path.join(HERE, "rays.c"), "-lembree3"], check=True)
    return program


def peers(args, mesh):
    embree = [compiled(), mesh]
    config = ["hugepages=0"] if args.small_pages else []
    yield Peer("embree", embree + config)
    if args.robust:
        yield Peer("embree robust", embree + ["robust"] + config)
    for path in args.ogee or [os.path.join(ROOT, "target", "release", "ogee")]:
        program, _, tree = path.partition(":")
        name = "ogee" if len(args.ogee) < 2 else "ogee " + path
        yield Peer(name, [os.path.abspath(program), "bench", "rays", mesh] + (["--tree", tree] if tree else []))


def write_rays(name, mesh, view, asker, side):
    """The files of the sets of rays, and how many rays each has. The first set is answered to aim the others."""
    file = lambda which: f"{name}-{which}.rays"
    camera = meshes.primary(view, side)
    camera.tofile(os.path.join(WORK, file("primary")))
    asker.order("closest", file("primary"), 0, len(camera))
    _, triangles, distances = asker.answers(file("primary"))
    camera.tofile(os.path.join(WORK, file("together")))
    counts = {"primary": len(camera), "together": len(camera)}
    for which, rays in meshes.beyond(view, mesh, camera, triangles, distances).items():
        rays.tofile(os.path.join(WORK, file(which)))
        counts[which] = len(rays)
    return {which: (file(which), counts[which]) for which in SETS}


def build(name, all, rounds):
    turns = [[peer.timed("build") for peer in all] for _ in range(rounds)]
    seconds = [min(turn[i][0] for turn in turns) for i in range(len(all))]
    cells = " | ".join(f"{1e3 * s:.1f} ms, {int(turns[0][i][1][0]) / 2**20:.1f} MiB" for i, s in enumerate(seconds))
    return f"| {name} | build | {cells} | {ratios(all, [1 / s for s in seconds])} |"


def ratios(all, speeds):
    return " | ".join(f"**{speed / speeds[0]:.2f}**" for peer, speed in zip(all, speeds) if not peer.name.startswith("embree"))


def ask(name, which, file, n, all, rounds):
    """Mrays/s of each peer as a row of the table."""
    order = ORDERS.get(which, "closest")
    best = np.full((len(all), -(-n // CHUNK)), np.inf)
    for _ in range(rounds):
        for chunk in range(best.shape[1]):
            for i, peer in enumerate(all):
                best[i, chunk] = min(best[i, chunk], peer.timed(order, file, chunk * CHUNK, CHUNK)[0])
    speeds = n / best.sum(1) / 1e6
    return f"| {name} | {which} | {' | '.join(f'{speed:.2f}' for speed in speeds)} | {ratios(all, speeds)} |"


def judge(name, which, file, n, all):
    """How each Embree's answers differ from those of the first Ogee."""
    ours = next(peer for peer in all if not peer.name.startswith("embree"))
    for peer in all:
        if peer.name.startswith("embree"):
            answers, _, _ = peer.answers(file)
            lost, made_up, other, judged, right, they = ours.order("judge", file, answers, MOST_JUDGED)
            yield f"| {name} | {which} | {peer.name} | {n} | {lost} | {made_up} | {other} | {judged} | {right} | {they} |"


def main():
    ask_for = argparse.ArgumentParser()
    ask_for.add_argument("--only", default="A,B,C,D")
    ask_for.add_argument("--sets", default=",".join(SETS))
    ask_for.add_argument("--side", type=int, default=1024, help="of the picture, pixels; a multiple of four")
    ask_for.add_argument("--rounds", type=int, default=5)
    ask_for.add_argument("--robust", action="store_true", help="Embree with its robust flag, besides")
    ask_for.add_argument("--small-pages", action="store_true", help="keep Embree from asking for huge pages, as it does by default")
    ask_for.add_argument("--ogee", action="append", default=[])
    args = ask_for.parse_args()
    os.makedirs(WORK, exist_ok=True)
    table, differences = [], []
    for name in args.only.split(","):
        make, view = meshes.scenes()[name]
        mesh = make()
        meshes.write_obj(os.path.join(WORK, f"{name}.obj"), *mesh)
        all = list(peers(args, f"{name}.obj"))
        if not table:
            ogees = [peer.name for peer in all if not peer.name.startswith("embree")]
            head = ["scene", "rays"] + [peer.name for peer in all] + [f"{ogee} / embree" for ogee in ogees]
            table += [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
            print("\n".join(table), flush=True)
        sets = write_rays(name, mesh, view, all[-1], args.side)
        print(build(name, all, args.rounds), flush=True)
        for which in args.sets.split(","):
            print(ask(name, which, *sets[which], all, args.rounds), flush=True)
            differences += judge(name, which, *sets[which], all)
        for peer in all:
            peer.end()
    print("\nWhere the two differ: `lost` rays meet something with Ogee alone, `made up` ones with Embree alone, others meet another triangle. The")
    print("numbers at the end: so many were tried against every triangle, so often Ogee was right, so often Embree.\n")
    print("| scene | rays | | of | lost | made up | another | tried | ogee right | embree right |\n" + "|---" * 10 + "|")
    print("\n".join(differences))


main()
