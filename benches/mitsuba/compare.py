#!/usr/bin/env python3
"""Measures Ogee's `path`, or another tracer, against Mitsuba 3 (`scalar_rgb`, `path`) on the same scenes, one thread each, in turn: CPU seconds,
an EXR file written by each included, and the error of each sample count, and the seconds to one error. The error needs no
reference: it is the spread of four pictures by other random numbers. Means of both are printed, so that a bias would be seen.

usage: compare.py [--samples N,…] [--tracer path|montecarlo|…] [--sampler sobol|independent] [--error E] [--only SCENE,…] [--ogee PATH]
needs: `pip install mitsuba numpy`, and `cargo build --release`."""
import argparse, math, os, resource, shutil, subprocess, tempfile, time
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
HERE = os.path.dirname(os.path.abspath(__file__))
SEEDS = 4
T = mi.ScalarTransform4f


def diffuse(*rgb):
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(rgb)}}


def wall(place, bsdf):
    return {"type": "rectangle", "to_world": place, "bsdf": bsdf}


def seen(eye, look_at, fov):
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 8, "rr_depth": 5},
        "sensor": {
            "type": "perspective", "fov": fov, "fov_axis": "smaller", "near_clip": 0.001, "far_clip": 1000,
            "to_world": T().look_at(origin=eye, target=look_at, up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 512, "height": 512, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent"},
        },
    }


def emits(*rgb):
    return {"emitter": {"type": "area", "radiance": {"type": "rgb", "value": list(rgb)}}}


def room():
    """Walls at ±1, open toward +z where the camera stands, a lamp under the ceiling."""
    white = diffuse(0.73, 0.73, 0.73)
    lamp = wall(T().translate([0, 0.99, 0]).rotate([1, 0, 0], 90).scale([0.23, 0.19, 1]), diffuse(0, 0, 0))
    return seen([0, 0, 3.9], [0, 0, 0], 39.3) | {
        "floor": wall(T().translate([0, -1, 0]).rotate([1, 0, 0], -90), white),
        "ceiling": wall(T().translate([0, 1, 0]).rotate([1, 0, 0], 90), white),
        "back": wall(T().translate([0, 0, -1]), white),
        "left": wall(T().translate([-1, 0, 0]).rotate([0, 1, 0], 90), diffuse(0.57, 0.043, 0.044)),
        "right": wall(T().translate([1, 0, 0]).rotate([0, 1, 0], -90), diffuse(0.105, 0.378, 0.076)),
        "lamp": lamp | emits(18.387, 13.9873, 6.75357),
    }


def blob(path, n=200):
    """80,000 triangles of a ball with bumps, as an OBJ file without normals."""
    v, u = np.meshgrid(np.linspace(0, math.pi, n + 1), np.linspace(0, 2 * math.pi, n, endpoint=False), indexing="ij")
    out = np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], -1)
    points = out * (0.8 + 0.12 * np.sin(7 * out[..., :1]) * np.sin(6 * out[..., 1:2] + 1) * np.sin(5 * out[..., 2:]))
    at = lambda row, column: 1 + row * n + column % n
    quads = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(n) for j in range(n)]
    with open(path, "w") as file:
        file.writelines("v %.9g %.9g %.9g\n" % tuple(p) for p in points.reshape(-1, 3))
        file.writelines(f"f {a} {b} {c}\nf {a} {c} {d}\n" for a, b, c, d in quads)


def outdoors(folder):
    """The blob on a square under a lamp and an even sky."""
    path = os.path.join(folder, "blob.obj")
    blob(path)
    lamp = wall(T().look_at(origin=[1.5, 3, 1], target=[0, 0, 0], up=[0, 1, 0]).scale(0.25), diffuse(0, 0, 0))
    earth = diffuse(0.6, 0.5, 0.4)
    return seen([1.2, 1.3, 2.6], [0, -0.15, 0], 42) | {
        "blob": {"type": "obj", "filename": path, "face_normals": True, "bsdf": earth},
        "ground": wall(T().translate([0, -0.9, 0]).rotate([1, 0, 0], -90).scale([4, 4, 1]), earth),
        "lamp": lamp | emits(60, 55, 45),
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.25, 0.3, 0.4]}},
    }


def block(at, turn, size):
    return {"type": "cube", "to_world": T().translate(at).rotate([0, 1, 0], turn).scale(size), "bsdf": diffuse(0.73, 0.73, 0.73)}


def ball(center, radius, bsdf):
    return {"type": "sphere", "center": center, "radius": radius, "bsdf": bsdf}


def scenes(folder):
    return {
        "cornell": room() | {
            "small": block([0.335, -0.7, 0.38], -17, 0.3),
            "large": block([-0.33, -0.4, -0.28], 18.25, [0.3, 0.61, 0.3]),
        },
        "glass": room() | {
            "glass": ball([0.45, -0.65, 0.3], 0.35, {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}),
            "mirror": ball([-0.42, -0.6, -0.3], 0.4, {"type": "conductor", "material": "none"}),
        },
        "outdoors": outdoors(folder),
    }


def by_mitsuba(folder, scene, samples, seed):
    start = time.process_time()
    rendered = mi.render(scene, spp=samples, seed=seed)
    mi.Bitmap(rendered).write(os.path.join(folder, "peer.exr"))
    seconds = time.process_time() - start
    return np.array(rendered, dtype=np.float64)[..., :3], seconds


def by_ogee(args, folder, name, samples, seed):
    out = os.path.join(folder, "out.exr")
    scene = shutil.copy(os.path.join(HERE, f"{name}.scene"), folder)
    command = [args.ogee, "render", scene, "-o", out, "--threads", "1", "--samples", str(samples)]
    command += ["--seed", str(seed), "--sampler", args.sampler, "--tracer", args.tracer]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    image = mi.Bitmap(out).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(image, dtype=np.float64), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def error(made):
    return math.sqrt(np.var([image for image, _ in made], axis=0, ddof=1).mean())


def seconds_to(wanted, rows):
    """CPU seconds to an error, by the line through the two rows around it (or the nearest two) in logarithms."""
    (e0, t0), (e1, t1) = sorted(sorted(rows, key=lambda row: abs(math.log(row[0] / wanted)))[:2])
    return math.exp(math.log(t0) + math.log(t1 / t0) * math.log(wanted / e0) / math.log(e1 / e0))


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--samples", default="4,16")
    ask.add_argument("--tracer", default="path")
    ask.add_argument("--sampler", default="sobol")
    ask.add_argument("--error", type=float, default=0.05)
    ask.add_argument("--only", default="cornell,glass,outdoors")
    ask.add_argument("--ogee", default=os.path.join(HERE, "..", "..", "target", "release", "ogee"))
    args = ask.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        compare(args, folder)


def compare(args, folder):
    print("| scene | samples | mitsuba cpu s | error | ogee cpu s | error | mean of ogee over mitsuba |\n|---|---|---|---|---|---|---|")
    described = scenes(folder)
    for name in args.only.split(","):
        scene, rows = mi.load_dict(described[name]), {"mitsuba": [], "ogee": []}
        for samples in map(int, args.samples.split(",")):
            made = {"mitsuba": [], "ogee": []}
            for seed in range(1, SEEDS + 1):
                made["mitsuba"].append(by_mitsuba(folder, scene, samples, seed))
                made["ogee"].append(by_ogee(args, folder, name, samples, seed))
            found = {who: (error(all), min(t for _, t in all)) for who, all in made.items()}
            means = {who: np.mean([image for image, _ in all]) for who, all in made.items()}
            cells = " | ".join(f"{found[who][1]:.2f} | {found[who][0]:.4f}" for who in rows)
            print(f"| {name} | {samples} | {cells} | {means['ogee'] / means['mitsuba']:.4f} |", flush=True)
            for who in rows:
                rows[who].append(found[who])
        t = {who: seconds_to(args.error, rows[who]) for who in rows}
        print(f"\n{name}: error {args.error} after {t['mitsuba']:.1f} s of mitsuba, {t['ogee']:.1f} s of ogee: ratio {t['mitsuba'] / t['ogee']:.2f}\n", flush=True)


main()
