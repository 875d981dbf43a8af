#!/usr/bin/env python3
"""Indirect light of Debian's povray and of Ogee side by side: the Cornell box by radiosity, a caustic by photons, the same geometry, camera
and lamps in both. CPU seconds of whole processes with one thread, in turn, medians; errors against the mean of two pictures of many
samples, whose difference tells how far off it is itself. Prints a table of each scene; writes its figures, a plot, and povray's best
picture beside the reference and their difference.

usage: light.py --out DIR [--runs N] [--ogee PATH] [--samples N] [--only cornell|caustic]
needs: povray on the path, `pip install numpy OpenEXR pillow`, and `cargo build --release`. Pictures go to target/povray."""
import argparse, json, math, os, statistics, sys
import numpy as np
import OpenEXR
from PIL import Image
from compare import HERE, ROOT
from compare import run as timed

WORK = os.path.join(ROOT, "target", "povray", "light")
COLOURS = ["#c0392b", "#2471a3", "#239b56", "#b9770e", "#7d3c98"]

# What povray is asked: name, its declaration. What ogee is asked: name, arguments, samples.
SCENES = {
    "cornell": {
        "size": (128, 128),
        "povray": [("default", "Q=0"), ("medium", "Q=1"), ("high", "Q=2")],
        "ogee": [
            ("path", ["--tracer", "path"], [4, 16, 64, 256]),
            ("path --denoise", ["--tracer", "path", "--denoise"], [4, 16, 64]),
            ("irradiance", ["--tracer", "irradiance"], [4, 16, 64, 256]),
            ("photon", ["--tracer", "photon"], [4, 16, 64]),
        ],
        "reference": ["--tracer", "path"],
    },
    "caustic": {
        "size": (200, 150),
        "povray": [("8,000 photons", "SP=0.02"), ("32,000", "SP=0.01"), ("200,000", "SP=0.004"), ("3.2 million", "SP=0.001")],
        "ogee": [("photon", ["--tracer", "photon"], [4, 16, 64, 256])],
        "reference": ["--tracer", "photon"],
    },
}


def run(command):
    """CPU seconds of a command that must succeed."""
    everywhere = ",".join(map(str, sorted(os.sched_getaffinity(0))))
    _, cpu, _, code, said = timed(command, everywhere)
    if code:
        sys.exit(f"{' '.join(command)}\n{said.decode()[-2000:]}")
    return cpu


def povray(name, size, declared, out):
    return ["povray", f"+I{HERE}/{name}.pov", f"+O{out}", f"+W{size[0]}", f"+H{size[1]}", "-D", "-A", "+FE", "+WT1", f"Declare={declared}"]


def ogee(args, name, size, asked, samples, out, seed=0):
    return [args.ogee, "render", f"{HERE}/{name}.scene", "-o", out, "--size", f"{size[0]}x{size[1]}", "--threads", "1", "--seed", str(seed),
            "--samples", str(samples)] + asked


def channels(path):
    return OpenEXR.File(path).channels()


def read(path):
    found = channels(path)
    whole = next((found[key].pixels for key in ("RGB", "RGBA") if key in found), None)
    return (whole[..., :3] if whole is not None else np.stack([found[key].pixels for key in "RGB"], -1)).astype(float)


def interior(args, name, size):
    """True at pixels that no outline crosses, nor one beside them: povray takes one sample in the middle, a reference takes the pixel's mean."""
    path = f"{WORK}/{name}-outlines.exr"
    run(ogee(args, name, size, ["--tracer", "raycast", "--layers", "normal,source"], 16, path))
    found = channels(path)
    normal = found["normal"].pixels if "normal" in found else np.stack([found[f"normal.{axis}"].pixels for axis in "XYZ"], -1)
    source = (found["source.id"] if "source.id" in found else found["source"]).pixels.reshape(normal.shape[:2])
    sure = (np.linalg.norm(normal, axis=-1) > 0.99) | (source == 0)
    rows, columns = sure.shape
    kept = np.zeros_like(sure)
    for y in range(1, rows - 1):
        for x in range(1, columns - 1):
            around = (slice(y - 1, y + 2), slice(x - 1, x + 2))
            kept[y, x] = sure[around].all() and (source[around] == source[y, x]).all()
    return kept


def errors(picture, reference, kept):
    off, true = (picture - reference)[kept], reference[kept]
    return math.sqrt((off**2).mean()), (off**2 / (true**2 + 0.01)).mean(), picture[kept].mean() / true.mean() - 1


def encoded(linear):
    c = np.clip(linear, 0, 1)
    return (np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055) * 255 + 0.5).astype(np.uint8)


def measured(args, name):
    """(program and method, setting, CPU seconds, errors) of each picture."""
    scene = SCENES[name]
    size = scene["size"]
    halves = [f"{WORK}/{name}-reference-{seed}.exr" for seed in (98, 99)]
    for seed, path in zip((98, 99), halves):
        run(ogee(args, name, size, scene["reference"], args.samples, path, seed=seed))
    first, second, kept = read(halves[0]), read(halves[1]), interior(args, name, size)
    truth = (first + second) / 2
    own = errors(truth + (first - second) / 2, truth, kept)
    asked = [("povray", word, lambda out, d=d: povray(name, size, d, out)) for word, d in scene["povray"]]
    for method, words, samples in scene["ogee"]:
        asked += [(f"ogee, {method}", f"{n} samples", lambda out, w=words, n=n: ogee(args, name, size, w, n, out)) for n in samples]
    seconds = {i: [] for i in range(len(asked))}
    for _ in range(args.runs):
        for i, (_, _, command) in enumerate(asked):
            seconds[i].append(run(command(f"{WORK}/{name}-{i}.exr")))
            print(name, asked[i][:2], seconds[i][-1], flush=True)
    pictures = [read(f"{WORK}/{name}-{i}.exr") for i in range(len(asked))]
    rows = [(*asked[i][:2], statistics.median(seconds[i]), *errors(pictures[i], truth, kept)) for i in range(len(asked))]
    last = len(scene["povray"]) - 1
    shown = [encoded(pictures[last]), encoded(truth), encoded(0.5 + 2 * (pictures[last] - truth))]
    Image.fromarray(np.concatenate(shown, 1)).save(f"{args.out}/{name}.png")
    return rows, kept.mean(), own


def plot(rows, title):
    """A plot of RMSE over CPU seconds, both by powers of ten."""
    width, height, left, low, right, top = 640, 400, 70, 50, 20, 40
    xs, ys = [r[2] for r in rows], [r[3] for r in rows]
    span = lambda values: (math.floor(math.log10(min(values)) * 2) / 2, math.ceil(math.log10(max(values)) * 2) / 2)
    (x0, x1), (y0, y1) = span(xs), span(ys)
    x = lambda v: left + (math.log10(v) - x0) / (x1 - x0) * (width - left - right)
    y = lambda v: height - low - (math.log10(v) - y0) / (y1 - y0) * (height - low - top)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/><text x="{left}" y="20" font-size="14">{title}: RMSE over CPU seconds</text>']
    for decade in range(math.ceil(x0), math.floor(x1) + 1):
        at = x(10.0**decade)
        parts.append(f'<path d="M{at:.1f} {top}V{height - low}" stroke="#ddd"/><text x="{at:.1f}" y="{height - low + 18}" text-anchor="middle">{10.0**decade:g} s</text>')
    for half in range(math.ceil(y0 * 2), math.floor(y1 * 2) + 1):
        at = y(10 ** (half / 2))
        parts.append(f'<path d="M{left} {at:.1f}H{width - right}" stroke="#ddd"/><text x="{left - 6}" y="{at + 4:.1f}" text-anchor="end">{10 ** (half / 2):.2g}</text>')
    for i, method in enumerate(dict.fromkeys(r[0] for r in rows)):
        points = [(x(r[2]), y(r[3])) for r in rows if r[0] == method]
        colour = COLOURS[i % len(COLOURS)]
        line = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="{colour}"/>' for a, b in points]
        parts.append(f'<rect x="{width - 170}" y="{top + 8 + 18 * i}" width="10" height="10" fill="{colour}"/>'
                     f'<text x="{width - 154}" y="{top + 17 + 18 * i}">{method}</text>')
    return "\n".join(parts + ["</svg>\n"])


def table(rows):
    lines = ["| | setting | CPU seconds | RMSE | relative MSE | mean |", "|---|---|---|---|---|---|"]
    lines += [f"| {method} | {word} | {s:.3g} | {rmse:.3g} | {relative:.3g} | {100 * mean:+.2f} % |" for method, word, s, rmse, relative, mean in rows]
    return "\n".join(lines)


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--out", required=True)
    ask.add_argument("--runs", type=int, default=1)
    ask.add_argument("--samples", type=int, default=2048)
    ask.add_argument("--only", default="")
    ask.add_argument("--ogee", default=os.path.join(ROOT, "target", "release", "ogee"))
    args = ask.parse_args()
    os.makedirs(WORK, exist_ok=True)
    os.makedirs(args.out, exist_ok=True)
    for name in SCENES:
        if args.only and name != args.only:
            continue
        rows, share, own = measured(args, name)
        with open(f"{args.out}/{name}.svg", "w") as out:
            out.write(plot(rows, name))
        with open(f"{args.out}/{name}.json", "w") as out:
            json.dump({"rows": rows, "interior": share, "reference": {"samples": 2 * args.samples, "rmse": own[0], "relative_mse": own[1]}}, out, indent=1)
        print(f"{name}: {100 * share:.1f} % of the pixels; the reference is off by {own[0]:.3g} itself, relative MSE {own[1]:.3g}\n{table(rows)}", flush=True)


if __name__ == "__main__":
    main()
