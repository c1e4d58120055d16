#!/usr/bin/env python3
"""Makes the solids of the planning examples (README.md beside this file) as volumes.

usage: make_scenes.py [FOLDER]

    wall.nrrd, piano.nrrd      a wall with a slot, and a piano that goes through it lying down only
    cage.nrrd                  a box with a hole; for the bunny in it see scale_stl.py
    plate.nrrd, elbow.nrrd     a plate with a hole, and an elbow whose arms go through it one after the other
"""
import os
import sys

SIDE = 64


class Volume:
    """Voxels of a universe of depth 6, filled and cleared by boxes [low, high)."""

    def __init__(self):
        self.voxels = bytearray(SIDE ** 3)

    def set(self, low, high, value=1):
        for z in range(low[2], high[2]):
            for y in range(low[1], high[1]):
                at = SIDE * (y + SIDE * z)
                self.voxels[at + low[0]:at + high[0]] = bytes([value]) * (high[0] - low[0])
        return self

    def clear(self, low, high):
        return self.set(low, high, 0)

    def write(self, path):
        with open(path, "wb") as file:
            file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 64 64 64\nencoding: raw\n\n")
            file.write(self.voxels)


def wall():
    return Volume().set((31, 0, 0), (34, 64, 64)).clear((31, 10, 28), (34, 54, 38))


def piano():
    """The case, upright, its keyboard toward +y, and its legs."""
    return (Volume().set((8, 26, 12), (18, 30, 42)).set((8, 30, 26), (18, 33, 29))
            .set((8, 30, 12), (10, 33, 26)).set((16, 30, 12), (18, 33, 26)))


def cage():
    return (Volume().set((6, 6, 2), (58, 58, 40)).clear((9, 9, 5), (55, 55, 37))
            .clear((22, 20, 37), (46, 42, 40)))


def plate():
    return Volume().set((31, 0, 0), (33, 64, 64)).clear((31, 26, 26), (33, 38, 38))


def elbow():
    return Volume().set((8, 26, 30), (24, 30, 34)).set((8, 30, 30), (12, 42, 34))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    for make in (wall, piano, cage, plate, elbow):
        make().write(os.path.join(folder, make.__name__ + ".nrrd"))
    print("wall, piano, cage, plate, elbow")


if __name__ == "__main__":
    main()
