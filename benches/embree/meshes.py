"""Meshes that programs are compared on, and rays through them. Made by number, the same at every run.

A  a ball of 1,310,720 triangles with ridges, seen from outside
B  a smooth lump of 81,920 on a square of two
C  a knotted tube of 200,000 in the middle of a stadium a hundred times as large
D  a box with two blocks in it, 36 triangles, most along the axes
"""
import numpy as np

GOLDEN = (1 + 5**0.5) / 2


def scenes():
    """By name: a function that makes (positions, triangles), and where the camera and the light stand."""
    return {
        "A": (ridges, dict(eye=(0.4, 0.8, 2.6), at=(0, 0, 0), fov=48, light=(3, 4, 3))),
        "B": (lump, dict(eye=(1.2, 1.3, 2.6), at=(0, -0.15, 0), fov=42, light=(3, 5, 2))),
        "C": (stadium, dict(eye=(0.8, 0.7, 2.6), at=(0, -0.1, 0), fov=48, light=(30, 40, 10))),
        "D": (box, dict(eye=(0, 0, 3.9), at=(0, 0, 0), fov=39.3, light=(0, 0.98, 0))),
    }


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def joined(parts):
    """Meshes as one."""
    firsts = np.cumsum([0] + [len(p) for p, _ in parts])
    return np.concatenate([p for p, _ in parts]), np.concatenate([t + first for (_, t), first in zip(parts, firsts)])


def quads(corners):
    """n × 4 × 3 corners as two triangles each."""
    corners = np.asarray(corners, float)
    first = 4 * np.arange(len(corners))[:, None, None]
    return corners.reshape(-1, 3), (first + [[0, 1, 2], [0, 2, 3]]).reshape(-1, 3)


def ball(level):
    """The icosahedron, each triangle cut in four `level` times."""
    a, b = 1, GOLDEN
    points = unit(np.array([(-a, b, 0), (a, b, 0), (-a, -b, 0), (a, -b, 0), (0, -a, b), (0, a, b), (0, -a, -b), (0, a, -b),
                            (b, 0, -a), (b, 0, a), (-b, 0, -a), (-b, 0, a)], float))
    faces = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                      (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    for _ in range(level):
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        unique, which = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = len(points) + which.reshape(3, -1)
        points = np.concatenate([points, unit(points[unique[:, 0]] + points[unique[:, 1]])])
        a, b, c = faces.T
        faces = np.stack([(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)], 1).transpose(2, 1, 0).reshape(-1, 3)
    return points, faces


def waves(points, octaves, frequency, seed, ridged):
    """Sums of twelve waves an octave, halved in height and twice as fine from one to the next."""
    random, total = np.random.default_rng(seed), np.zeros(len(points))
    for octave in range(octaves):
        along, phase = unit(random.normal(size=(12, 3))), random.uniform(0, 2 * np.pi, 12)
        wave = np.sin(points @ along.T * frequency * 2.03**octave * np.pi + phase).sum(1) / 24**0.5
        total += 0.5**octave * (0.5 - np.abs(wave) if ridged else wave)
    return total


def ridges():
    points, faces = ball(8)
    return points * (1 + 0.35 * waves(points, 6, 1.5, 1, True))[:, None], faces


def lump():
    points, faces = ball(6)
    points = points * (1 + 0.3 * waves(points, 4, 0.8, 2, False))[:, None]
    y = points[:, 1].min() - 0.01
    return joined([(points, faces), quads([[(-10, y, -10), (-10, y, 10), (10, y, 10), (10, y, -10)]])])


def knot(n_along=1000, n_around=100):
    def center(t):
        r = 2 + np.cos(3 * t)
        return np.stack([r * np.cos(2 * t), 1.2 * np.sin(3 * t), r * np.sin(2 * t)], -1) / 3

    u, w = np.arange(n_along) / n_along * 2 * np.pi, np.arange(n_around) / n_around * 2 * np.pi
    tangent = center(u + 1e-4) - center(u - 1e-4)
    side = unit(np.cross(tangent, (0, 1, 0)))
    across = unit(np.cross(tangent, side))
    radius = 0.12 * (1 + 0.15 * np.sin(40 * u)[:, None] * np.sin(6 * w))[..., None]
    ring = side[:, None] * np.cos(w)[:, None] + across[:, None] * np.sin(w)[:, None]
    points = (center(u)[:, None] + radius * ring).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n_along), np.arange(n_around), indexing="ij")
    at = lambda i, j: (i % n_along * n_around + j % n_around).ravel()
    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def stadium():
    y, tiles = -0.6, range(-100, 100, 20)
    ground = [[(x, y, z), (x, y, z + 20), (x + 20, y, z + 20), (x + 20, y, z)] for x in tiles for z in tiles]
    at = lambda r, h, k: (r * np.cos(2 * np.pi * k / 64), h, r * np.sin(2 * np.pi * k / 64))
    rows = []
    for row in range(12):
        r, h = 40 + 4 * row, y + 2 * row
        for k in range(64):
            rows.append([at(r, h, k), at(r, h + 2, k), at(r, h + 2, k + 1), at(r, h, k + 1)])
            rows.append([at(r, h + 2, k), at(r + 4, h + 2, k), at(r + 4, h + 2, k + 1), at(r, h + 2, k + 1)])
    return joined([knot(), quads(ground + rows)])


def block(center, half, degrees):
    turn = np.radians(degrees)
    turned = np.array([(np.cos(turn), 0, np.sin(turn)), (0, 1, 0), (-np.sin(turn), 0, np.cos(turn))])
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half @ turned.T + center
    return [corners[list(side)] for side in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))]


def box():
    walls = [[(-1, -1, -1), (-1, -1, 1), (1, -1, 1), (1, -1, -1)], [(-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1)],
             [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)], [(-1, -1, -1), (-1, 1, -1), (-1, 1, 1), (-1, -1, 1)],
             [(1, -1, -1), (1, -1, 1), (1, 1, 1), (1, 1, -1)]]
    lamp = [[(-0.23, 0.99, -0.19), (0.23, 0.99, -0.19), (0.23, 0.99, 0.19), (-0.23, 0.99, 0.19)]]
    return quads(walls + lamp + block((0.335, -0.7, 0.38), (0.3, 0.3, 0.3), -17) + block((-0.33, -0.4, -0.28), (0.3, 0.61, 0.3), 18.25))


def write_obj(path, positions, triangles):
    """Every f32 with so many digits that it is the same number as f64."""
    with open(path, "w") as file:
        file.writelines("v %.17g %.17g %.17g\n" % tuple(p) for p in positions.astype(np.float32).tolist())
        file.writelines("f %d %d %d\n" % tuple(t) for t in (triangles + 1).tolist())


def rays(origin, direction, t_max):
    """n × 7 numbers as files of rays hold them."""
    n = len(direction)
    parts = np.broadcast_to(origin, (n, 3)), direction, np.broadcast_to(np.asarray(t_max, float).reshape(-1, 1), (n, 1))
    return np.concatenate(parts, axis=1).astype(np.float32)


def primary(view, side):
    """Rays of a square picture, in squares of four by four pixels."""
    eye = np.array(view["eye"], float)
    forward = unit(np.array(view["at"], float) - eye)
    right = unit(np.cross(forward, (0, 1, 0)))
    up = np.cross(right, forward)
    tile, inner = np.divmod(np.arange(side * side), 16)
    x = tile % (side // 4) * 4 + inner % 4 + 0.5
    y = tile // (side // 4) * 4 + inner // 4 + 0.5
    half = np.tan(np.radians(view["fov"]) / 2)
    a, b = (2 * x / side - 1) * half, (1 - 2 * y / side) * half
    return rays(eye, unit(forward + a[:, None] * right + b[:, None] * up), np.inf)


def beyond(view, mesh, camera, triangles, distances):
    """From where camera rays end: a ray to the light and one by the cosine from each, and the latter shuffled."""
    met = np.isfinite(distances)
    positions = mesh[0].astype(np.float32).astype(float)
    a, b, c = positions[mesh[1][triangles[met]]].transpose(1, 0, 2)
    from_camera, t = camera[met].astype(float), distances[met].astype(float)[:, None]
    normal = np.cross(b - a, c - a)
    flat = (normal**2).sum(1) == 0
    normal = unit(np.where(flat[:, None], -from_camera[:, 3:6], normal))
    normal *= -np.sign((normal * from_camera[:, 3:6]).sum(1, keepdims=True) + 1e-300)
    # A ten-thousandth of the way off the surface, so that no program meets it again.
    origin = (from_camera[:, :3] + t * from_camera[:, 3:6] + 1e-4 * (1 + t) * normal).astype(np.float32).astype(float)
    to_light = np.array(view["light"], float) - origin
    far = np.linalg.norm(to_light, axis=1, keepdims=True)
    random = np.random.default_rng(7)
    # A point of the unit sphere on top of the normal is there by the cosine.
    z, turn = random.uniform(-1, 1, len(t)), random.uniform(0, 2 * np.pi, len(t))
    r = np.sqrt(1 - z * z)
    bounced = unit(normal + np.stack([r * np.cos(turn), r * np.sin(turn), z], 1))
    bounce = rays(origin, bounced, np.inf)
    return {
        "shadow": rays(origin, to_light / far, far * (1 - 1e-4)),
        "bounce": bounce,
        "shuffled": bounce[random.permutation(len(bounce))],
    }
