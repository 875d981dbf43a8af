#!/usr/bin/env python3
"""Measures Ogee's `path` against Mitsuba 3 (`scalar_rgb`, `path`) on the same boxes, one thread each, in turn: CPU seconds and
the error of each sample count, and the seconds to one error. The error needs no reference: of two pictures by other
random numbers, E[(a - b)^2] is twice the variance. Means of both are printed, so that a bias would be seen.

usage: compare.py [--samples N,…] [--error E] [--ogee PATH]
needs: `pip install mitsuba numpy`, and `cargo build --release`."""
import argparse, math, os, resource, subprocess, tempfile, time
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
HERE = os.path.dirname(os.path.abspath(__file__))
T = mi.ScalarTransform4f


def diffuse(*rgb):
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(rgb)}}


def wall(place, bsdf):
    return {"type": "rectangle", "to_world": place, "bsdf": bsdf}


def room():
    """Walls at ±1, open toward +z where the camera stands, a lamp under the ceiling."""
    white = diffuse(0.73, 0.73, 0.73)
    radiance = {"type": "rgb", "value": [18.387, 13.9873, 6.75357]}
    lamp = wall(T().translate([0, 0.99, 0]).rotate([1, 0, 0], 90).scale([0.23, 0.19, 1]), diffuse(0, 0, 0))
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 8, "rr_depth": 5},
        "sensor": {
            "type": "perspective", "fov": 39.3, "near_clip": 0.001, "far_clip": 1000,
            "to_world": T().look_at(origin=[0, 0, 3.9], target=[0, 0, 0], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 512, "height": 512, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent"},
        },
        "floor": wall(T().translate([0, -1, 0]).rotate([1, 0, 0], -90), white),
        "ceiling": wall(T().translate([0, 1, 0]).rotate([1, 0, 0], 90), white),
        "back": wall(T().translate([0, 0, -1]), white),
        "left": wall(T().translate([-1, 0, 0]).rotate([0, 1, 0], 90), diffuse(0.57, 0.043, 0.044)),
        "right": wall(T().translate([1, 0, 0]).rotate([0, 1, 0], -90), diffuse(0.105, 0.378, 0.076)),
        "lamp": lamp | {"emitter": {"type": "area", "radiance": radiance}},
    }


def block(at, turn, size):
    return {"type": "cube", "to_world": T().translate(at).rotate([0, 1, 0], turn).scale(size), "bsdf": diffuse(0.73, 0.73, 0.73)}


def ball(center, radius, bsdf):
    return {"type": "sphere", "center": center, "radius": radius, "bsdf": bsdf}


SCENES = {
    "cornell": {
        "small": block([0.335, -0.7, 0.38], -17, 0.3),
        "large": block([-0.33, -0.4, -0.28], 18.25, [0.3, 0.61, 0.3]),
    },
    "glass": {
        "glass": ball([0.45, -0.65, 0.3], 0.35, {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}),
        "mirror": ball([-0.42, -0.6, -0.3], 0.4, {"type": "conductor", "material": "none"}),
    },
}


def by_mitsuba(scene, samples, seed):
    start = time.process_time()
    image = np.array(mi.render(scene, spp=samples, seed=seed), dtype=np.float64)[..., :3]
    return image, time.process_time() - start


def by_ogee(ogee, name, samples, seed):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.exr")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        scene = os.path.join(HERE, f"{name}.scene")
        command = [ogee, "render", scene, "-o", out, "--threads", "1", "--samples", str(samples), "--seed", str(seed)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        image = mi.Bitmap(out).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
        return np.array(image, dtype=np.float64), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def error(pair):
    return math.sqrt(((pair[0][0] - pair[1][0]) ** 2).mean() / 2)


def seconds_to(wanted, rows):
    """CPU seconds to an error, by the line through the two rows around it (or the nearest two) in logarithms."""
    (e0, t0), (e1, t1) = sorted(sorted(rows, key=lambda row: abs(math.log(row[0] / wanted)))[:2])
    return math.exp(math.log(t0) + math.log(t1 / t0) * math.log(wanted / e0) / math.log(e1 / e0))


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--samples", default="4,16")
    ask.add_argument("--error", type=float, default=0.05)
    ask.add_argument("--ogee", default=os.path.join(HERE, "..", "..", "target", "release", "ogee"))
    args = ask.parse_args()
    print("| scene | samples | mitsuba cpu s | error | ogee cpu s | error | mean of ogee over mitsuba |\n|---|---|---|---|---|---|---|")
    for name, objects in SCENES.items():
        scene, rows = mi.load_dict(room() | objects), {"mitsuba": [], "ogee": []}
        for samples in map(int, args.samples.split(",")):
            pairs = {"mitsuba": [], "ogee": []}
            for seed in (1, 2):
                pairs["mitsuba"].append(by_mitsuba(scene, samples, seed))
                pairs["ogee"].append(by_ogee(args.ogee, name, samples, seed))
            found = {who: (error(pair), min(t for _, t in pair)) for who, pair in pairs.items()}
            means = {who: (pair[0][0] + pair[1][0]).mean() for who, pair in pairs.items()}
            cells = " | ".join(f"{found[who][1]:.2f} | {found[who][0]:.4f}" for who in rows)
            print(f"| {name} | {samples} | {cells} | {means['ogee'] / means['mitsuba']:.4f} |", flush=True)
            for who in rows:
                rows[who].append(found[who])
        t = {who: seconds_to(args.error, rows[who]) for who in rows}
        print(f"\n{name}: error {args.error} after {t['mitsuba']:.1f} s of mitsuba, {t['ogee']:.1f} s of ogee: ratio {t['mitsuba'] / t['ogee']:.2f}\n", flush=True)


main()
