"""What Blackleaf demands of its own speed and size, and whether the stored figures hold it (bench/compare --check)."""
import tables

MEGABYTE = 1e6
ATLAS_VOXELS = 181 * 217 * 181  # of aal.nii.gz
NANOSECOND = 1e-9


class Figures:
    """Stored results; a figure that was not made is told by KeyError."""

    def __init__(self, results):
        self.results = results

    def ours(self, key):
        return self.results[key]["ours"]

    def times(self, key, who):
        """How many times ours the other takes."""
        result = self.results[key]
        return result["peers"][who] / tables.beside(result, who)

    def two_threads(self, key):
        """How far a figure of two threads is above what it must reach: 1 at 1.8 times one thread, or at 1.4 reads."""
        speedup = self.ours(f"{key}/t1") / self.ours(f"{key}/t2")
        return max(speedup / 1.8, 1.4 * self.times(f"{key}/t2", "read"))

    def an_edge(self, key):
        """Seconds a unit feature edge."""
        return self.ours(key) / self.results[key]["edges"]

    def error(self, key, who):
        """Relative difference."""
        return abs(self.times(key, who) - 1)

    def growth(self, smaller, larger):
        return self.ours(larger) / self.ours(smaller)

    def megabytes_a_second(self, key, side):
        """Of in-memory octree."""
        return self.ours(f"memory/{side}") / self.ours(f"{key}/{side}/t2") / MEGABYTE


def demands():
    """(what, value of the figures, at least or at most, bound)"""
    for side in ("512", "1024"):
        key = f"voxels/{side}/t1"
        yield f"{key}: its time in plain reads", lambda f, k=key: 1 / f.times(k, "read"), "at most", 1.3
        yield f"{key}: OpenVDB, z fastest", lambda f, k=key: f.times(k, "openvdb-z"), "at least", 20
        yield f"{key}: OpenVDB, same layout", lambda f, k=key: f.times(k, "openvdb"), "at least", 40
        yield f"{key}: OctoMap", lambda f, k=key: f.times(k, "octomap"), "at least", 50
        key = f"voxels/{side}"
        yield f"{key}/t2: part of what two threads must reach", lambda f, k=key: f.two_threads(k), "at least", 1
    for side in ("512", "1024"):
        key = f"mesh/{side}/t1"
        yield f"{key}: OpenVDB, half-width 1", lambda f, k=key: f.times(k, "openvdb-1"), "at least", 15
        yield f"wrong/{side}: voxels", lambda f, k=f"wrong/{side}": f.ours(k), "at most", 0
    yield "mesh: growth from 512 to 1024", lambda f: f.growth("mesh/512/t1", "mesh/1024/t1"), "at most", 4.3
    key = "translate/1024/t1"
    yield f"{key}: move by the same vector", lambda f, k=key: f.times(k, "move"), "at least", 3
    yield f"{key}: OpenVDB, copying and pruning", lambda f, k=key: f.times(k, "openvdb-copy"), "at least", 10
    yield f"{key}: OpenVDB, GridTransformer", lambda f, k=key: f.times(k, "openvdb"), "at least", 80
    yield "memory/1024: OpenVDB", lambda f: f.times("memory/1024", "openvdb"), "at least", 4
    for key in ("combine", "combine-and", "combine-minus"):
        for who in ("openvdb-csg", "openvdb-csg-copy"):
            yield f"{key}/1024/t1: {who}", lambda f, k=f"{key}/1024/t1", w=who: f.times(k, w), "at least", 10
    yield "combine/1024/t1: OpenVDB topology", lambda f: f.times("combine/1024/t1", "openvdb-topology-copy"), "at least", 10
    for radius in ("1", "4", "16"):
        key = f"offset-{radius}/1024/t1"
        yield f"{key}: OpenVDB filter", lambda f, k=key: f.times(k, "openvdb-filter"), "at least", 10
    for side in ("512", "1024"):
        for who in ("openvdb", "octomap", "bits-zstd", "octomap-zstd"):
            yield f"file/{side}: {who}", lambda f, k=f"file/{side}", w=who: f.times(k, w), "at least", 1
        for key in ("save", "load"):
            yield f"{key}/{side}/t2: MB/s", lambda f, k=key, s=side: f.megabytes_a_second(k, s), "at least", 200
    for side, openvdb, blocks in (("512", 30, 15), ("1024", 60, 50)):
        key = f"move/{side}/t1"
        yield f"{key}: OpenVDB", lambda f, k=key: f.times(k, "openvdb"), "at least", openvdb
        yield f"{key}: dense, in blocks", lambda f, k=key: f.times(k, "dense-blocks"), "at least", blocks
    yield "move/512/t1: WA87 as printed", lambda f: f.times("move/512/t1", "paper"), "at least", 50
    yield "move-speedup/1024: two threads", lambda f: f.ours("move-speedup/1024"), "at least", 1.8
    yield "move/1024/t2: ms", lambda f: f.ours("move/1024/t2") * 1e3, "at most", 40
    for side in (512, 1024, 2048, 4096, 8192, 16384):
        key = f"move-growth/{side}"
        yield f"{key}: of a level", lambda f, k=key: f.ours(k), "at most", 4.3
    key = "move-memory/1024"
    yield f"{key}: of source and target", lambda f, k=key: 1 / f.times(k, "source+target"), "at most", 1.1
    for work in ("build", "move"):
        key = f"mpi/{work}/1024"
        yield f"{key}: two ranks", lambda f, k=key: f.ours(f"{k}/n1") / f.ours(f"{k}/n2"), "at least", 1.8
        yield f"{key}/n1: in the time of blackleaf", lambda f, k=f"{key}/n1": 1 / f.times(k, "blackleaf"), "at most", 1.1
    yield "sweep/512/t1: each move, all united", lambda f: f.times("sweep/512/t1", "moves"), "at least", 3
    for side in ("128", "256"):
        key = f"interfere/{side}"
        for end in ("", "_p95"):
            yield f"{key}: FCL octree-octree{end}", lambda f, k=key, e=end: f.times(k, "fcl-octree" + e), "at least", 20
            yield f"{key}: FCL mesh-mesh{end}", lambda f, k=key, e=end: f.times(k, "fcl-mesh" + e), "at least", 1
    for side in ("128", "256", "512"):
        key = f"interfere-voxelised/{side}"
        yield f"{key}: exact", lambda f, k=key: f.times(k, "exact"), "at least", 0.9
    for smaller, larger in (("128", "256"), ("256", "512")):
        yield (f"interfere/{larger}: growth", lambda f, s=smaller, l=larger: f.growth(f"interfere/{s}", f"interfere/{l}"),
               "at most", 1.6)
    yield "interfere-batch-speedup/256: two threads", lambda f: f.ours("interfere-batch-speedup/256"), "at least", 1.8
    for end in ("", "_p95"):
        yield f"distance/256: FCL octree-octree{end}", lambda f, e=end: f.times("distance/256", "fcl-octree" + e), "at least", 1
        yield f"distance/256: in interference tests{end}", lambda f, e=end: 1 / f.times("distance/256", "interfere" + e), "at most", 20
    yield "query/512: in OpenVDB's getValue", lambda f: 1 / f.times("query/512", "openvdb"), "at most", 1.2
    yield "ray/1024: OctoMap castRay", lambda f: f.times("ray/1024", "octomap"), "at least", 10
    yield "draw/256/t1: us a unit feature edge", lambda f: f.an_edge("draw/256/t1") / 1e-6, "at most", 1
    for side in (256, 1024):
        key = f"draw-speedup/{side}"
        yield f"{key}: two threads", lambda f, k=key: f.ours(k), "at least", 1.8
    yield "draw-edge/1024: an edge, times that at 256", lambda f: f.ours("draw-edge/1024"), "at most", 1.5
    yield "draw/1024/t1: seconds", lambda f: f.ours("draw/1024/t1"), "at most", 5
    for radius, poly in ((32, 20), (64, 60)):
        key = f"draw/ball{radius}/t1"
        yield f"{key}: OpenCASCADE, triangles", lambda f, k=key: f.times(k, "opencascade-poly"), "at least", poly
        yield f"{key}: VA88 as printed", lambda f, k=key: f.times(k, "paper"), "at least", 1000
    for radius in (8, 16, 32):
        key = f"length/ball{radius}"
        yield f"{key}: off OpenCASCADE's exact one", lambda f, k=key: f.error(k, "opencascade-exact"), "at most", 1e-6
    yield "length/ball8: off 453.924338", lambda f: abs(f.ours("length/ball8") - 453.924338), "at most", 1e-6
    key = "draw-memory/1024"
    yield f"{key}: of strokes and octree", lambda f, k=key: 1 / f.times(k, "strokes+octree"), "at most", 4
    yield "plan/narrow: RRT-Connect over FCL octrees", lambda f: f.times("plan/narrow", "fcl-octree"), "at least", 5
    for smaller, larger in (("plan/narrow", "plan/narrow-128"), ("plan/narrow-128", "plan/narrow-256")):
        yield f"{larger}: growth", lambda f, s=smaller, l=larger: f.growth(s, l), "at most", 1.6
    yield "svg/1024: MB/s", lambda f: f.ours("svg-bytes/1024") / f.ours("svg/1024") / MEGABYTE, "at least", 100
    yield "curve/decode: ns", lambda f: f.ours("curve/decode") / NANOSECOND, "at most", 12
    yield "curve/encode: ns", lambda f: f.ours("curve/encode") / NANOSECOND, "at most", 12
    yield "curve/walk: ns a voxel", lambda f: f.ours("curve/walk") / NANOSECOND, "at most", 1.5
    yield "labels/atlas: million voxels/s", lambda f: ATLAS_VOXELS / f.ours("labels/atlas") / 1e6, "at least", 300


def report(results):
    """Lines for people, and whether all demands hold."""
    figures, lines, all_hold = Figures(results), [], True
    for what, value_of, relation, bound in demands():
        try:
            value = value_of(figures)
        except KeyError:
            verdict, shown = "not measured", "-"
        else:
            verdict = "holds" if (value <= bound if relation == "at most" else value >= bound) else "FAILS"
            shown = f"{value:.3g}"
        all_hold = all_hold and verdict == "holds"
        lines.append(f"{what:48} {shown:>8}  {relation} {bound:<5g} {verdict}")
    return lines, all_hold
