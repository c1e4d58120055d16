#!/usr/bin/env python3
"""Scales a binary STL mesh and moves it.

usage: scale_stl.py IN.stl LONGEST X,Y,Z OUT.stl

Its longest side becomes LONGEST, the middle of its box X,Y,Z.
"""
import struct
import sys


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    longest, middle = float(sys.argv[2]), [float(number) for number in sys.argv[3].split(",")]
    with open(sys.argv[1], "rb") as file:
        head, count = file.read(80), struct.unpack("<I", file.read(4))[0]
        facets = [list(struct.unpack("<12fH", file.read(50))) for _ in range(count)]
    corners = [facet[at:at + 3] for facet in facets for at in (3, 6, 9)]
    low, high = ([pick(corner[i] for corner in corners) for i in range(3)] for pick in (min, max))
    scale = longest / max(high[i] - low[i] for i in range(3))
    for facet in facets:
        for at in range(3, 12):
            axis = at % 3
            facet[at] = (facet[at] - (low[axis] + high[axis]) / 2) * scale + middle[axis]
    with open(sys.argv[4], "wb") as file:
        file.write(head + struct.pack("<I", count) + b"".join(struct.pack("<12fH", *facet) for facet in facets))


if __name__ == "__main__":
    main()
