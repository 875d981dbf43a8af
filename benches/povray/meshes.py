#!/usr/bin/env python3
"""Writes the generated inputs of the comparison into a folder: a displaced sphere as mesh.inc (mesh2) and mesh.obj, and
a flat file of literal spheres in both languages, flat.pov and flat.scene.

usage: meshes.py FOLDER [TRIANGLE_ROWS] [SPHERES]"""
import sys
from math import cos, pi, sin

folder, rows, n = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 500, int(sys.argv[3]) if len(sys.argv) > 3 else 200_000


def point(i, j, columns):
    """radius(θ, φ) = 1 + 0.08 sin 8φ sin²θ sin 6θ + 0.02 sin 40φ sin²θ sin 40θ"""
    theta, phi = pi * j / rows, 2 * pi * i / columns
    s2 = sin(theta) ** 2
    r = 1 + 0.08 * sin(8 * phi) * s2 * sin(6 * theta) + 0.02 * sin(40 * phi) * s2 * sin(40 * theta)
    return r * sin(theta) * cos(phi), r * cos(theta), r * sin(theta) * sin(phi)


columns = 2 * rows
vertices = [point(0, 0, columns)] + [point(i, j, columns) for j in range(1, rows) for i in range(columns)] + [point(0, rows, columns)]
index = lambda i, j: 0 if j == 0 else len(vertices) - 1 if j == rows else 1 + (j - 1) * columns + i % columns
faces = []
for j in range(rows):
    for i in range(columns):
        a, b, c, d = index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)
        faces += [(a, b, d)] if j != 0 else []
        faces += [(a, d, c)] if j != rows - 1 else []

with open(f"{folder}/mesh.inc", "w") as out:
    out.write("mesh2 {\n vertex_vectors { %d" % len(vertices) + "".join(",\n<%.6f,%.6f,%.6f>" % v for v in vertices) + " }\n")
    out.write(" face_indices { %d" % len(faces) + "".join(",\n<%d,%d,%d>" % f for f in faces) + " }\n")
    out.write(" pigment { color rgb <0.8,0.7,0.6> } finish { ambient 0 diffuse 0.8 }\n}\n")
with open(f"{folder}/mesh.obj", "w") as out:
    out.writelines("v %.6f %.6f %.6f\n" % v for v in vertices)
    out.writelines("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in faces)

radius = 20 / n ** (1 / 3) * 0.25
with open(f"{folder}/flat.pov", "w") as pov, open(f"{folder}/flat.scene", "w") as scene:
    pov.write("#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\ncamera { perspective location <0,0,-28> look_at <0,0,0> angle 45 "
              "right x*image_width/image_height up y }\nlight_source { <20,30,-30> color rgb 1 }\n")
    scene.write("render { size 640, 480  samples 1 }\ncamera { eye <0, 0, 28>  look_at <0, 0, 0>  fov 34.5158770189817 }\n"
                "light { point <20, 30, 30>  intensity pi  falloff 0, 0, 1 }\n")
    for i in range(1, n + 1):
        x, y, z = ((i * c) % 1 for c in (0.7548776662466927, 0.5698402909980532, 0.4301597090019468))
        pov.write("sphere { <%.6f, %.6f, %.6f>, %.6f pigment { color rgb <%.3f, %.3f, %.3f> } finish { ambient 0 diffuse 0.8 } }\n"
                  % (20 * x - 10, 20 * y - 10, 20 * z - 10, radius, x, y, z))
        scene.write("sphere { center <%.6f, %.6f, %.6f>  radius %.6f  material { diffuse <%.4f, %.4f, %.4f> } }\n"
                    % (20 * x - 10, 20 * y - 10, 10 - 20 * z, radius, 0.8 * x, 0.8 * y, 0.8 * z))
print(f"{len(faces)} triangles, {n} spheres in {folder}")
