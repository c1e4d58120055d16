#!/usr/bin/env python3
"""Draws the silhouettes of the objects in VA88 (Veenstra and Ahuja, 1988, Figures 5 to 11).

usage: make_silhouettes.py [FOLDER]

Writes PNG images and, for every object, NAME.json (sphere.toml for the sphere) into FOLDER (default: here). Then

    blackleaf build cup.json -o cup.octree
    blackleaf draw cup.octree --view 12,-16,15 -o cup.svg

The paper gives its figures' shapes but no measures; those here are ours, in half voxels from the middle of a universe of
128 voxels a side, so that everything is a comparison of whole numbers. Pixels are one voxel wide in every view.
Needs nothing but Python 3.
"""
import json
import os
import struct
import sys
import zlib

SIDE = 128  # pixels a side, and voxels of the universe

FRONT, RIGHT, TOP = [0, -1, 0], [1, 0, 0], [0, 0, 1]
EDGES = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]]
CORNERS = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]]


# Silhouettes: functions of u (to the right) and v (upward).

def disc(radius):
    return lambda u, v: u * u + v * v <= radius * radius


def box(left, right, low, high):
    return lambda u, v: left <= u <= right and low <= v <= high


def triangle(half_base, low, high):
    """Upright and symmetric, its base at v = low, its tip at v = high."""
    return lambda u, v: v >= low and abs(u) * (high - low) <= half_base * (high - v)


def diamond(radius):
    return lambda u, v: abs(u) + abs(v) <= radius


def union(*parts):
    return lambda u, v: any(part(u, v) for part in parts)


def without(whole, hole):
    return lambda u, v: whole(u, v) and not hole(u, v)


# The coffee cup: a body that widens upward, and a handle to the right, open in the front view.

def cup_body(u, v):
    return -84 <= v <= 84 and 14 * abs(u) <= 14 * 56 + (v + 84)


def cup_handle(u, v):
    return u >= 56 and 30 * 30 <= (u - 64) ** 2 + v * v <= 46 * 46


# The object that hides parts of itself: two towers and a step on a base, with a notch, and a window in the taller tower.

BLOCKS_FRONT = without(union(box(-96, 96, -96, -48), box(-96, -32, -96, 80), box(48, 96, -96, 16)),
                       box(-80, -48, 16, 48))
BLOCKS_RIGHT = union(box(-96, 96, -96, -48), box(-32, 96, -96, 16), box(32, 96, -96, 80))
BLOCKS_TOP = without(box(-96, 96, -96, 96), box(-16, 32, -96, -16))

CONE = triangle(96, -96, 96)

OBJECTS = {
    "cylinder": [(FRONT, box(-80, 80, -96, 96)), (RIGHT, box(-80, 80, -96, 96)), (TOP, disc(80))],
    "cone": [(TOP, disc(96))] + [(view, CONE) for view in (
        FRONT, RIGHT, [1, 1, 0], [1, -1, 0], [2, 1, 0], [2, -1, 0], [1, 2, 0], [1, -2, 0])],
    "sphere": [(view, disc(112)) for view in [FRONT, RIGHT, TOP] + EDGES + CORNERS],
    "pyramid": [(FRONT, CONE), (RIGHT, CONE), (TOP, box(-96, 96, -96, 96))],
    "cup": [(FRONT, union(cup_body, cup_handle)), (RIGHT, cup_body),
            (TOP, union(disc(68), box(0, 110, -12, 12)))],
    "blocks": [(FRONT, BLOCKS_FRONT), (RIGHT, BLOCKS_RIGHT), (TOP, BLOCKS_TOP)],
    "diamond": [(FRONT, diamond(112)), (RIGHT, diamond(112)), (TOP, diamond(112))],
}


def png(silhouette):
    """A grayscale PNG image, white where the silhouette is."""
    rows = b""
    for row in range(SIDE):
        v = SIDE - 1 - 2 * row
        rows += b"\0" + bytes(255 if silhouette(2 * column + 1 - SIDE, v) else 0 for column in range(SIDE))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", SIDE, SIDE, 8, 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) +
            chunk(b"IEND", b""))


def toml(depth, views):
    lines = [f"depth = {depth}"]
    for view in views:
        lines.append("\n[[views]]")
        lines += [f"{key} = {json.dumps(value)}" for key, value in view.items()]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        sys.exit(__doc__)
    folder = sys.argv[1] if len(sys.argv) == 2 else "."
    os.makedirs(folder, exist_ok=True)
    depth = SIDE.bit_length() - 1
    for name, pictures in OBJECTS.items():
        views, written = [], {}
        for direction, silhouette in pictures:
            data = png(silhouette)
            if data not in written:  # views that see the same share an image
                written[data] = f"{name}{len(written) + 1}.png"
                with open(os.path.join(folder, written[data]), "wb") as file:
                    file.write(data)
            views.append({"image": written[data], "view": direction, "pixel_size": 1})
        if name == "sphere":
            suffix, text = "toml", toml(depth, views)
        else:
            rows = ",\n".join("    " + json.dumps(view) for view in views)
            suffix, text = "json", f'{{"depth": {depth}, "views": [\n{rows}\n]}}\n'
        with open(os.path.join(folder, f"{name}.{suffix}"), "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
