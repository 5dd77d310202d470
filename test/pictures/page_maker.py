"""Makes pages that play synthetic runs, as docs/notes/page.md says and without any code of the product.

    page_maker.py FOLDER    writes a page of each kind into FOLDER, to look at
"""

import base64
import copy
import json
import os
import re
import sys
import zlib

import numpy as np

PLAYER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "src", "pictures", "player")
THREE = "/usr/share/javascript/three"
PLACES = (PLAYER, THREE, os.path.join(THREE, "examples", "js", "controls"))
MISSING = 65535


# ---------------------------------------------------------------- the file

def track_bytes(values):
    """Return a number over time as its smallest and largest value and differences of 16 bits."""
    values = np.asarray(values, dtype=float)
    known = values[~np.isnan(values)]
    if not known.size:
        return np.array([np.nan, np.nan]).astype("<f8").tobytes()
    low, high = known.min(), known.max()
    if known.size < values.size and low == high:
        high = low + 1.0  # a constant track cannot have gaps
    head = np.array([low, high]).astype("<f8").tobytes()
    if low == high:
        return head
    steps = np.full(values.size, MISSING, dtype=np.int64)
    steps[~np.isnan(values)] = np.rint((known - low) / (high - low) * 65534)
    differences = np.diff(steps, prepend=0) % 65536
    return head + (differences % 256).astype(np.uint8).tobytes() + (differences // 256).astype(np.uint8).tobytes()


def mesh_bytes(vertices, triangles):
    """Return a mesh as its bounds, 16 bits for each coordinate, and indices."""
    vertices = np.asarray(vertices, dtype=float)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    size = np.where(high > low, high - low, 1.0)
    return (np.concatenate([low, high]).astype("<f8").tobytes()
            + np.rint((vertices - low) / size * 65535).astype("<u2").tobytes()
            + np.asarray(triangles).astype("<u4").tobytes())


class Run:
    """A picture and the numbers of its tracks, in the order of the tracks."""

    def __init__(self, picture, times, tracks, meshes=()):
        self.picture, self.times, self.meshes = picture, np.asarray(times, dtype=float), meshes
        self.tracks = [np.asarray(track, dtype=float) for track in tracks]

    def motion(self):
        data = self.times.astype("<f8").tobytes() + b"".join(track_bytes(track) for track in self.tracks)
        return zlib.compress(data + b"".join(mesh_bytes(*mesh) for mesh in self.meshes), 6)

    def elements(self):
        picture = json.dumps(self.picture).replace("<", "\\u003c")
        return (f'<script type="application/json" class="flexarm-picture">{picture}</script>\n'
                f'<script type="text/plain" class="flexarm-motion">{base64.b64encode(self.motion()).decode()}</script>')

    def copy(self, **changes):
        """Return the same run with some members of its picture changed."""
        picture = copy.deepcopy(self.picture)
        picture.update(changes)
        return Run(picture, self.times, self.tracks, self.meshes)


def text_of(name):
    for place in PLACES:
        path = os.path.join(place, name)
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                return file.read()
    raise FileNotFoundError(name)


# Other colours than those of the product, so that tests see where they come from.
SETTINGS = {"colors": {"amounts": ["#000080", "#008000", "#ffff00"], "signed": ["#0000ff", "#808080", "#ff0000"]},
            "first_time": 0}


def settings_element(settings):
    return f'<script type="application/json" class="flexarm-settings">{json.dumps(settings)}</script>'


def page(elements, settings):
    """Return the player's page, with all that it names in one file, and these elements as its runs."""
    lines = []
    for line in text_of("player.html").split("\n"):
        style = re.fullmatch(r'\s*<link rel="stylesheet" href="([^"]+)">\s*', line)
        script = re.fullmatch(r'\s*<script src="([^"]+)"></script>\s*', line)
        if style:
            line = "<style>\n" + text_of(style.group(1)) + "</style>"
        elif script:
            line = "<script>\n" + text_of(script.group(1)) + "</script>"
        elif line.strip() == "<!-- runs -->":
            line = "\n".join([settings_element(settings), *elements])
        lines.append(line)
    return "\n".join(lines)


def write_page(path, *runs, **settings):
    """Write a page that plays runs. A text in place of a run goes into the page as it is.

    @param settings  other values of SETTINGS
    """
    with open(path, "w", encoding="utf-8") as file:
        file.write(page([run if isinstance(run, str) else run.elements() for run in runs], {**SETTINGS, **settings}))


# ---------------------------------------------------------------- motion

def product(p, q):
    """Return the product of quaternions x y z w; the last axis has their components."""
    px, py, pz, pw = np.moveaxis(np.asarray(p, dtype=float), -1, 0)
    qx, qy, qz, qw = np.moveaxis(np.asarray(q, dtype=float), -1, 0)
    return np.stack([pw * qx + px * qw + py * qz - pz * qy, pw * qy - px * qz + py * qw + pz * qx,
                     pw * qz + px * qy - py * qx + pz * qw, pw * qw - px * qx - py * qy - pz * qz], axis=-1)


def turned(q, v):
    """Return vectors turned by quaternions."""
    q, v = np.asarray(q, dtype=float), np.asarray(v, dtype=float)
    u, w = q[..., :3], q[..., 3:]
    return v + 2 * w * np.cross(u, v) + 2 * np.cross(u, np.cross(u, v))


def about(axis, angle):
    """Return quaternions of rotations about an axis of unit length."""
    angle = np.asarray(angle, dtype=float)
    return np.concatenate([np.sin(angle / 2)[..., None] * np.asarray(axis, dtype=float), np.cos(angle / 2)[..., None]],
                          axis=-1)


class Chain:
    """Poses of frames over time: a place and a quaternion for each instant."""

    def __init__(self, place, turn):
        self.place, self.turn = place, turn

    def then(self, offset, turn):
        return Chain(self.place + turned(self.turn, np.broadcast_to(offset, self.place.shape)),
                     product(self.turn, np.broadcast_to(turn, self.turn.shape)))

    def tracks(self):
        return [*self.place.T, *self.turn.T]


def bent_beam(root, length, count, curvature, stiffness):
    """Return the sections of a beam whose curvature about y falls linearly to zero at its tip, and their tracks.

    @param curvature  about y at the root, for each instant [1/m]
    """
    arcs, sections, tracks = np.linspace(0, length, count), [], []
    fine = np.linspace(0, length, 20 * (count - 1) + 1)
    angle = curvature[:, None] * (fine - fine**2 / (2 * length))
    step = fine[1] - fine[0]
    middle, zeros = (angle[:, 1:] + angle[:, :-1]) / 2, np.zeros((len(curvature), 1))
    x, z = (np.concatenate([zeros, np.cumsum(function(middle), axis=1)], axis=1) for function in (np.cos, np.sin))
    for k, arc in enumerate(arcs):
        offset = np.stack([step * x[:, 20 * k], 0 * curvature, -step * z[:, 20 * k]], axis=1)
        sections.append(root.then(offset, about([0, 1, 0], angle[:, 20 * k])))
        bending = curvature * (1 - arc / length)
        zero = 0 * bending
        tracks += sections[-1].tracks()
        tracks += [2e-5 * bending, zero, 1e-4 * bending, 0.05 * bending, bending, zero]
        tracks += [30 * bending, zero, stiffness * curvature / length, 0.1 * stiffness * bending, stiffness * bending,
                   zero]
    return arcs, sections, tracks


def rest_sections(arcs):
    return [[arc, 0, 0, 0, 0, 0, 1] for arc in arcs]


def shape(kind, pose, color, **rest):
    return dict({"kind": kind, "pose": pose, "color": color}, **rest)


def at(x, y, z):
    return [x, y, z, 0, 0, 0, 1]


LYING = [0.4, 0, 0, 0, 0.7071067811865476, 0, 0.7071067811865476]  # the z axis along x
ACROSS = [0.7071067811865476, 0, 0, 0.7071067811865476]  # the z axis along -y


def wedge():
    """Return a mesh of five sides whose edges are sharp: a vertex occurs once for each side."""
    a, b, c, d, e, f = ((-0.05, -0.04, -0.03), (0.05, -0.04, -0.03), (0.05, 0.04, -0.03), (-0.05, 0.04, -0.03),
                        (-0.05, -0.04, 0.05), (-0.05, 0.04, 0.05))
    vertices, triangles = [], []
    for face in ((a, d, c, b), (a, e, f, d), (b, c, f, e), (a, b, e), (d, f, c)):
        first = len(vertices)
        vertices += face
        triangles += [(first, first + k, first + k + 1) for k in range(1, len(face) - 1)]
    return vertices, triangles


def swinging_arm(frames=201, duration=4.0, name="swinging arm", phase=0.0):
    """Return a run of an arm with a gripper and two flexible links, of which only the upper one has shapes."""
    t = np.linspace(0, duration, frames)
    pan = 0.6 * np.sin(2 * np.pi * t / duration + phase)
    shoulder = -0.5 + 0.45 * np.sin(2 * np.pi * t / 2 + phase)
    elbow = 1.1 + 0.5 * np.cos(2 * np.pi * t / 2 + phase)
    first = 0.5 * np.sin(2 * np.pi * t / 2 + 1.2 + phase) + 0.12 * np.sin(2 * np.pi * 4 * t)
    second = 0.7 * np.cos(2 * np.pi * t / 2 + 0.4 + phase) + 0.15 * np.sin(2 * np.pi * 5 * t)
    still = np.broadcast_to([0.0, 0, 0, 1], (frames, 4))
    base = Chain(np.zeros((frames, 3)), still.copy())
    column = base.then([0, 0, 0.3], about([0, 0, 1], pan))
    upper = column.then([0, 0, 0.12], about([0, 1, 0], shoulder))
    upper_arcs, upper_sections, upper_tracks = bent_beam(upper, 0.8, 11, first, 40.0)
    lower = upper_sections[-1].then([0, 0, 0], about([0, 1, 0], elbow))
    lower_arcs, lower_sections, lower_tracks = bent_beam(lower, 0.7, 9, second, 25.0)
    gripper = lower_sections[-1].then([0, 0, 0], about([0, 1, 0], 0 * t + 0.4))
    left = gripper.then([0.08, 0.045, 0], still)
    right = gripper.then([0.08, -0.045, 0], still)
    tip = gripper.then([0.14, 0, 0], still)

    steel, blue, dark = [0.72, 0.74, 0.78, 1], [0.24, 0.42, 0.68, 1], [0.25, 0.27, 0.31, 1]
    links = [
        {"name": "world", "parent": -1, "beam": -1, "stick": [], "shapes": [
            shape("cylinder", at(0, 0, 0.09), dark, radius=0.14, length=0.18),
            shape("cylinder", at(0, 0, 0.24), steel, radius=0.09, length=0.12)]},
        {"name": "column", "parent": 0, "beam": -1, "stick": [], "shapes": [
            shape("box", at(0, 0, 0.05), blue, size=[0.16, 0.12, 0.1]),
            shape("cylinder", [0, 0, 0.12, *ACROSS], dark, radius=0.06, length=0.16)]},
        {"name": "upper arm", "parent": 1, "beam": 0, "stick": [], "shapes": [
            shape("box", at(0.4, 0, 0), [0.93, 0.6, 0.2, 1], size=[0.8, 0.05, 0.02]),
            shape("cylinder", LYING, steel, radius=0.016, length=0.8)]},
        {"name": "forearm", "parent": 2, "beam": 1, "stick": [[0.7, 0, 0]], "shapes": []},
        {"name": "gripper", "parent": 3, "beam": -1, "stick": [], "shapes": [
            shape("mesh", at(0.03, 0, 0), blue, mesh=0), shape("box", at(0.07, 0, 0), dark, size=[0.03, 0.12, 0.04])]},
        {"name": "left finger", "parent": 4, "beam": -1, "stick": [], "shapes": [
            shape("box", at(0.03, 0, 0), steel, size=[0.08, 0.015, 0.03])]},
        {"name": "right finger", "parent": 4, "beam": -1, "stick": [], "shapes": [
            shape("box", at(0.03, 0, 0), steel, size=[0.08, 0.015, 0.03])]},
        {"name": "payload", "parent": 4, "beam": -1, "stick": [], "shapes": [
            shape("box", at(0, 0, 0), [0.8, 0.25, 0.25, 0.85], size=[0.07, 0.07, 0.07])]},
    ]
    columns, values, joints = [], [], []
    for joint, (link, kind, axis, position) in {
            "pan": (1, "continuous", [0, 0, 1], pan), "shoulder": (2, "revolute", [0, 1, 0], shoulder),
            "elbow": (3, "revolute", [0, 1, 0], elbow)}.items():
        first_column = len(columns)
        velocity = np.gradient(position, t) if frames > 1 else 0 * position
        for quantity, unit, series in (("position", "rad", position), ("velocity", "rad/s", velocity),
                                       ("effort", "N m", 12 * np.sin(3 * t) * position)):
            columns.append({"name": f"joint/{joint}/{quantity}", "unit": unit})
            values.append(series)
        joints.append({"name": joint, "link": link, "kind": kind, "axis": axis,
                       "columns": list(range(first_column, first_column + 3))})
    joints.append({"name": "wrist", "link": 4, "kind": "fixed", "axis": None, "columns": []})
    columns.append({"name": "energy/total", "unit": "J"})
    values.append(35 + 0.4 * np.exp(-t) * np.cos(9 * t))

    zero = np.zeros(frames)
    effort = [*upper.place.T, zero, zero, zero, zero, 12 * np.sin(2 * np.pi * t / 2), zero]
    load = [*tip.place.T, zero, zero, -20 + 5 * np.sin(t), zero, zero, zero]
    reaction = [*base.place.T, zero, zero, 25 + 0 * t, zero, 3 * np.cos(t), zero]
    tracks = []
    for chain in (base, column, upper, lower, gripper, left, right, tip):
        tracks += chain.tracks()
    tracks += upper_tracks + lower_tracks + list(tip.place.T) + effort + load + reaction + values
    picture = {
        "name": name, "title": f"arm.urdf, {duration:g} s",
        "notes": ["The mesh bracket.stl was not found; it is not shown."],
        "extent": {"center": [0, 0, 0.42], "radius": 1.7, "half": [1.7, 1.7, 1.7]}, "gravity": [0, 0, -9.81],
        "links": links,
        "meshes": [{"name": "wedge", "vertices": 18, "triangles": 8}],
        "beams": [{"link": 2, "arc_lengths": list(upper_arcs), "sections": rest_sections(upper_arcs), "radius": 0.027},
                  {"link": 3, "arc_lengths": list(lower_arcs), "sections": rest_sections(lower_arcs), "radius": 0.018}],
        "joints": joints, "probes": [{"name": "tip", "link": 4}],
        "floors": [{"pose": at(0, 0, 0), "size": [4, 3], "cell": 0.5, "ground": True}],
        "arrows": [{"kind": "effort", "count": 1}, {"kind": "load", "count": 1}, {"kind": "reaction", "count": 1}],
        "columns": columns, "frames": frames, "clips": [], "still": None,
    }
    return Run(picture, t, tracks, [wedge()])


def marker(path, duration=1.0, gravity=(0, 0, -9.81), color=(1, 0, 1, 1), name="marker"):
    """Return a run of a small sphere that moves along the points of a path, in equal times."""
    path = np.asarray(path, dtype=float)
    t = np.linspace(0, duration, len(path))
    still = np.broadcast_to([0.0, 0, 0, 1], (len(path), 4))
    picture = {
        "name": name, "title": name, "notes": [], "extent": {"center": [0, 0, 0], "radius": 1, "half": [1, 1, 1]},
        "gravity": list(gravity),
        "links": [{"name": "ball", "parent": -1, "beam": -1, "stick": [], "shapes": [
            shape("sphere", at(0, 0, 0), list(color), radius=0.03)]}], "meshes": [], "beams": [], "joints": [],
        "probes": [], "floors": [], "arrows": [], "columns": [], "frames": len(path), "clips": [], "still": None,
    }
    return Run(picture, t, Chain(path, still.copy()).tracks())


def modes(name="modes"):
    """Return three natural modes of a beam without shapes, one after the other, beside the beam at rest."""
    clip, count, times, curvatures = [], 25, [], []
    now = 0.0
    for mode, frequency in enumerate((1.5, 4.0, 7.5)):
        clip.append({"name": f"mode {mode + 1}: {frequency} Hz", "first": mode * count, "count": count})
        phase = np.linspace(0, 2 * np.pi, count)
        times.append(now + phase / (2 * np.pi * frequency))
        curvatures.append(1.2 / (1 + mode) * np.sin(phase))
        now = times[-1][-1] + 1e-3
    t, curvature = np.concatenate(times), np.concatenate(curvatures)
    still = np.broadcast_to([0.0, 0, 0, 1], (t.size, 4))
    root = Chain(np.zeros((t.size, 3)), still.copy())
    arcs, _, tracks = bent_beam(root, 1.0, 13, curvature, 20.0)
    picture = {
        "name": name, "title": "rod.urdf, modes", "notes": [],
        "extent": {"center": [0.5, 0, 0], "radius": 0.7, "half": [0.7, 0.7, 0.7]},
        "gravity": [0, 0, -9.81],
        "links": [{"name": "rod", "parent": -1, "beam": 0, "stick": [], "shapes": []}], "meshes": [],
        "beams": [{"link": 0, "arc_lengths": list(arcs), "sections": rest_sections(arcs), "radius": 0.01}],
        "joints": [], "probes": [], "floors": [], "arrows": [], "columns": [], "frames": int(t.size), "clips": clip,
        "still": 0,
    }
    return Run(picture, t, root.tracks() + tracks)


def net(beams=500, sections=20, frames=60):
    """Return a run of many waving beams, to measure the speed of the player."""
    t = np.linspace(0, 2, frames)
    links, descriptions, roots, tracks = [], [], [], []
    side = int(np.ceil(np.sqrt(beams)))
    still = np.broadcast_to([0.0, 0, 0, 1], (frames, 4))
    for k in range(beams):
        place = np.broadcast_to([0.4 * (k % side), 0.4 * (k // side), 0.5], (frames, 3))
        root = Chain(place.copy(), still.copy())
        arcs, _, beam_tracks = bent_beam(root, 0.38, sections, 1.5 * np.sin(np.pi * t + 0.1 * k), 1.0)
        roots += root.tracks()
        tracks += beam_tracks
        links.append({"name": f"beam {k}", "parent": -1, "beam": k, "stick": [], "shapes": []})
        descriptions.append({"link": k, "arc_lengths": list(arcs), "sections": rest_sections(arcs), "radius": 0.01})
    picture = {
        "name": "net", "title": f"{beams * sections} sections", "notes": [],
        "extent": {"center": [0.2 * side, 0.2 * side, 0.4], "radius": 0.3 * side,
                   "half": [0.2 * side, 0.2 * side, 0.1]},
        "gravity": [0, 0, -9.81],
        "links": links, "meshes": [], "beams": descriptions, "joints": [], "probes": [], "floors": [], "arrows": [],
        "columns": [], "frames": frames, "clips": [], "still": None,
    }
    return Run(picture, t, roots + tracks)


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    write_page(os.path.join(folder, "arm.html"), swinging_arm())
    write_page(os.path.join(folder, "arms.html"), swinging_arm(), swinging_arm(name="stiffer arm", phase=0.8))
    write_page(os.path.join(folder, "modes.html"), modes())
    write_page(os.path.join(folder, "net.html"), net())
    write_page(os.path.join(folder, "frame.html"), swinging_arm(frames=1))


if __name__ == "__main__":
    main()
