"""Where a glTF file's skin takes its vertices, or its clip its nodes, computed with numpy from the file alone: the numbers in
tests/suite/models.rs.

    python3 tests/oracle/skins.py FILE CLIP SECONDS [HOW_MANY]

CLIP is a name or a number. Linear blending; weights are divided by their sums. Of a file without skins it prints where the point (1, 1, 1)
of each node goes that the clip moves."""

import json
import os
import struct
import sys

import numpy as np

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read(path):
    data = open(path, "rb").read()
    if data[:4] != b"glTF":
        doc = json.loads(data)
        return doc, open(os.path.join(os.path.dirname(path), doc["buffers"][0]["uri"]), "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def accessor(doc, blob, index):
    a = doc["accessors"][index]
    view = doc["bufferViews"][a["bufferView"]]
    kind, width = np.dtype(COMPONENTS[a["componentType"]]), WIDTHS[a["type"]]
    stride = view.get("byteStride", kind.itemsize * width)
    start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
    rows = [np.frombuffer(blob, kind, width, start + i * stride) for i in range(a["count"])]
    values = np.array(rows, dtype=np.float64)
    if a.get("normalized"):
        values /= np.iinfo(kind).max
    return values


def rotation(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def local(node):
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    m = np.eye(4)
    m[:3, :3] = rotation(np.array(node.get("rotation", [0, 0, 0, 1.0]))) @ np.diag(node.get("scale", [1.0, 1, 1]))
    m[:3, 3] = node.get("translation", [0.0, 0, 0])
    return m


def slerp(a, b, s):
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    cosine = a @ b
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-8:
        return a + s * (b - a)
    return (np.sin((1 - s) * angle) * a + np.sin(s * angle) * b) / np.sin(angle)


def sample(times, values, t, is_rotation, mode):
    times = times[:, 0]
    k = min(max(int(np.searchsorted(times, t, side="right")) - 1, 0), len(times) - 2)
    step = times[k + 1] - times[k]
    s = min(max((t - times[k]) / step, 0.0), 1.0)
    if mode == "STEP":
        return values[k + 1] if s == 1.0 else values[k]
    if mode == "CUBICSPLINE":
        (_, a, out), (into, b, _) = values[3 * k : 3 * k + 3], values[3 * k + 3 : 3 * k + 6]
        powers = np.array([1.0, s, s**2, s**3])
        basis = np.array([[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1]]) @ powers
        return basis @ np.array([a, step * out, b, step * into])
    return slerp(values[k], values[k + 1], s) if is_rotation else values[k] + s * (values[k + 1] - values[k])


def main():
    path, clip, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    how_many = int(sys.argv[4]) if len(sys.argv) > 4 else 12
    doc, blob = read(path)
    names = [a.get("name", str(i)) for i, a in enumerate(doc["animations"])]
    animation = doc["animations"][names.index(clip) if clip in names else int(clip)]
    nodes = [dict(node) for node in doc["nodes"]]
    for channel in animation["channels"]:
        sampler, target = animation["samplers"][channel["sampler"]], channel["target"]
        mode = sampler.get("interpolation", "LINEAR")
        times, values = accessor(doc, blob, sampler["input"]), accessor(doc, blob, sampler["output"])
        nodes[target["node"]][target["path"]] = sample(times, values, seconds, target["path"] == "rotation", mode)
    world = {}

    def place(i, above):
        world[i] = above @ local(nodes[i])
        for child in nodes[i].get("children", []):
            place(child, world[i])

    for root in doc["scenes"][doc.get("scene", 0)]["nodes"]:
        place(root, np.eye(4))
    if "skins" not in doc:
        for node in sorted({channel["target"]["node"] for channel in animation["channels"]}):
            goes = ", ".join(f"{x:.9f}" for x in (world[node] @ [1, 1, 1, 1])[:3])
            print(f'("{clip}", {node}, {seconds}, [{goes}]),')
        return
    owner = next(n for n in doc["nodes"] if "skin" in n)
    skin, primitive = doc["skins"][owner["skin"]], doc["meshes"][owner["mesh"]]["primitives"][0]
    inverse = accessor(doc, blob, skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    matrices = np.array([world[j] @ inverse[k] for k, j in enumerate(skin["joints"])])
    get = lambda name: accessor(doc, blob, primitive["attributes"][name])
    points = np.c_[get("POSITION"), np.ones(len(get("POSITION")))]
    joints, weights = get("JOINTS_0").astype(int), get("WEIGHTS_0")
    weights /= weights.sum(axis=1, keepdims=True)
    moved = np.einsum("vk,vkij,vj->vi", weights, matrices[joints], points)[:, :3]
    size = np.linalg.norm(moved.max(axis=0) - moved.min(axis=0))
    print(f"// {path} {clip} {seconds}: size {size:.6f}")
    for v in np.linspace(0, len(moved) - 1, how_many).astype(int):
        print(f"({v}, [{', '.join(f'{x:.9f}' for x in moved[v])}]),")


main()
