"""ranks_test.py MPIRUN BLACKLEAF_MPI BLACKLEAF MAKE_HDF5 SOURCE_DIR [GROUP ...]

blackleaf-mpi under mpirun: the same files from any number of ranks and from blackleaf, and one message when a rank fails.
With --table instead of groups: the checksums for docs/MPI.md.
"""
import gzip
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MPIRUN, SHARED, SINGLE, MAKE_HDF5, SOURCE = sys.argv[1:6]
RANKS = (1, 2, 3, 4, 7)
ATLAS = "/usr/share/mricron/templates/aal.nii.gz"
ATLAS_SIZE = (181, 217, 181)

# More ranks than processors, as root, without a network.
os.environ.update({
    "LC_ALL": "C", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_pml": "ob1", "OMPI_MCA_btl": "self,vader",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMPI_MCA_plm": "isolated", "OMPI_MCA_oob_tcp_if_include": "lo",
})


def run(words, **more):
    return subprocess.run([str(word) for word in words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          timeout=300, **more)


class Folder(unittest.TestCase):
    """A folder of the test's own, and both programs in it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="blackleaf-ranks-")
        cls.prepare()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def prepare(cls):
        pass

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def single(cls, *words):
        done = run([SINGLE, *words], cwd=cls.folder)
        assert done.returncode == 0, done.stderr
        return done

    @classmethod
    def ranks(cls, count, *words):
        return run([MPIRUN, "-n", count, SHARED, *words], cwd=cls.folder)

    def done(self, count, *words):
        done = self.ranks(count, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def sum(self, name):
        with open(self.path(name), "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()

    def same(self, *words, ranks=RANKS, more=()):
        """What blackleaf writes and tells, whatever the ranks."""
        expected = self.single(*words, "-o", "expected.octree")
        wanted = self.sum("expected.octree")
        for count in ranks:
            done = self.done(count, *words, "-o", "result.octree", *more)
            self.assertEqual(self.sum("result.octree"), wanted, f"{count} ranks: {' '.join(words)}")
            self.assertEqual(done.stdout, expected.stdout.replace("expected.octree", "result.octree"), f"{count} ranks")
            os.remove(self.path("result.octree"))
            if TABLE is not None:
                TABLE.append((" ".join(words), count, wanted))

    def refused(self, count, *words, part, code=2):
        """One message, and nothing new in the folder."""
        before = sorted(os.listdir(self.folder))
        done = self.ranks(count, *words)
        self.assertEqual(done.returncode, code, done.stderr)
        messages = [line for line in done.stderr.splitlines() if line.startswith("blackleaf-mpi: ")]
        self.assertEqual(len(messages), 1, done.stderr)
        self.assertIn(part, messages[0])
        self.assertNotIn("octree", done.stdout)
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        return done


TABLE = None


def raw_atlas(folder):
    """The atlas as it comes, but for its packing; its values alone."""
    with gzip.open(ATLAS) as packed:
        whole = packed.read()
    with open(os.path.join(folder, "atlas.nii"), "wb") as file:
        file.write(whole)
    offset = 352
    values = whole[offset:offset + ATLAS_SIZE[0] * ATLAS_SIZE[1] * ATLAS_SIZE[2]]
    with open(os.path.join(folder, "atlas.raw"), "wb") as file:
        file.write(values)
    return values


def nrrd(size, kind, data, more=""):
    return (f"NRRD0004\ntype: {kind}\ndimension: 3\nsizes: {size[0]} {size[1]} {size[2]}\n{more}encoding: raw\n"
            f"data file: {data}\n\n")


class Build(Folder):
    @classmethod
    def prepare(cls):
        cls.values = raw_atlas(cls.folder)
        with open(cls.path("atlas.nhdr"), "w") as file:
            file.write(nrrd(ATLAS_SIZE, "uint8", "atlas.raw"))
        with open(cls.path("swapped.mha"), "wb") as file:
            file.write(b"ObjectType = Image\nNDims = 3\nDimSize = %d %d %d\nElementType = MET_SHORT\nElementByteOrderMSB = True\n"
                       b"ElementSpacing = 1 2 3\nElementDataFile = LOCAL\n" % ATLAS_SIZE)
            wide = bytearray(2 * len(cls.values))
            wide[1::2] = cls.values
            file.write(bytes(wide))

    def test_atlas(self):
        self.same("build", "atlas.nii")

    def test_part_of_the_values(self):
        self.same("build", "atlas.nhdr", "--range", "20:60", "--centre", "--depth", "9", ranks=(3, 7))

    def test_swapped_values(self):
        self.same("build", "swapped.mha", "--label", "37", ranks=(2, 7))

    def test_threads(self):
        self.same("build", "atlas.nii", ranks=(2,), more=("--threads", "2"))
        self.same("build", "atlas.nii", ranks=(3,), more=("--threads", "1"))

    def test_one_block(self):
        """A universe that cannot be cut: one rank does all."""
        with open(self.path("small.raw"), "wb") as file:
            file.write(bytes(x * y * z % 3 for z in range(5) for y in range(6) for x in range(7)))
        with open(self.path("small.nhdr"), "w") as file:
            file.write(nrrd((7, 6, 5), "uint8", "small.raw"))
        self.same("build", "small.nhdr", ranks=(1, 3))

    def test_hdf5(self):
        made = run([MAKE_HDF5, "atlas.raw", "atlas.h5", *ATLAS_SIZE], cwd=self.folder)
        self.assertEqual(made.returncode, 0, made.stderr)
        with open(self.path("sides.nhdr"), "w") as file:
            file.write(nrrd(ATLAS_SIZE, "uint8", "atlas.raw",
                            "space: left-posterior-superior\nspace directions: (0.002,0,0) (0,0.003,0) (0,0,0.004)\nspace origin: (0,0,0)\n"))
        self.single("build", "sides.nhdr", "-o", "sides.octree")
        self.refused(2, "build", "atlas.h5", "-o", "h5.octree", part="has 2 datasets of three dimensions: more, scan")
        sums = set()
        for count in RANKS:
            self.done(count, "build", "atlas.h5", "--dataset", "scan", "-o", "h5.octree", "--quiet")
            sums.add(self.sum("h5.octree"))
        self.assertEqual(len(sums), 1)
        difference = self.single("combine", "h5.octree", "xor", "sides.octree", "-o", "none.octree", "--quiet")
        self.assertIn("no voxel is black", self.single("combine", "h5.octree", "xor", "sides.octree", "-o", "none.octree").stderr)
        self.assertNotIn("different frames", difference.stderr)

    def test_bunny_at_512(self):
        self.single("build", os.path.join(SOURCE, "data", "bunny.stl"), "--depth", "9", "-o", "bunny.octree")
        self.single("export", "bunny.octree", "--raw", "-o", "one.nrrd")
        self.done(3, "export", "bunny.octree", "--raw", "-o", "bunny.nrrd")
        self.assertEqual(self.sum("one.nrrd"), self.sum("bunny.nrrd"))
        os.remove(self.path("one.nrrd"))
        self.same("build", "bunny.nrrd")
        self.single("build", "bunny.nrrd", "-o", "again.octree", "--quiet")
        self.assertIn("no voxel is black", self.single("combine", "again.octree", "xor", "bunny.octree", "-o", "none.octree").stderr)
        os.remove(self.path("bunny.nrrd"))


class Motion(Folder):
    @classmethod
    def prepare(cls):
        raw_atlas(cls.folder)
        cls.single("build", os.path.join(SOURCE, "data", "bunny.stl"), "--depth", "9", "-o", "bunny.octree")
        cls.single("build", "atlas.nii", "--depth", "9", "-o", "atlas.octree")
        cls.single("build", "atlas.nii", "--labels", "-o", "labels.octree")

    def test_move(self):
        self.same("move", "bunny.octree", "--rotate", "1,1,1:30", "--translate", "5.3,-7.1,2.9", "--about", "centre")

    def test_move_atlas(self):
        self.same("move", "atlas.octree", "--rotate", "0,1,2:77", "--about", "centroid", "--grow", ranks=(2, 7))

    def test_quarter_turns_and_reflections(self):
        self.same("move", "bunny.octree", "--rotate", "0,0,1:90", "--about", "centre", ranks=(3,))
        self.same("move", "bunny.octree", "--rotate", "0,0,1:90", "--about", "centroid", "--clip", ranks=(4,))
        self.same("move", "bunny.octree", "--reflect", "x", "--rotate", "1,2,3:10", "--about", "centre", ranks=(2,))

    def test_nothing_moves(self):
        expected = self.single("move", "bunny.octree", "--translate", "0,0,0", "-o", "expected.octree")
        self.done(3, "move", "bunny.octree", "--translate", "0,0,0", "-o", "result.octree")
        self.assertEqual(self.sum("result.octree"), self.sum("expected.octree"))
        self.assertEqual(expected.returncode, 0)

    def test_translate(self):
        self.same("translate", "bunny.octree", "3,-5,8")
        self.same("translate", "atlas.octree", "0,0,600", "--clip", ranks=(3,))

    def test_combine(self):
        self.same("combine", "bunny.octree", "or", "atlas.octree")
        for operation in ("and", "minus", "xor"):
            self.same("combine", "bunny.octree", operation, "atlas.octree", ranks=(4,))

    def test_labels(self):
        """Maps of labels are moved by every rank alike."""
        self.same("translate", "labels.octree", "3,-5,8", "--clip", ranks=(2,))
        self.same("move", "labels.octree", "--label", "37", "--rotate", "0,0,1:10", "--about", "centre", ranks=(3,))

    def test_info_and_export(self):
        self.assertEqual(self.done(3, "info", "bunny.octree", "--json").stdout, self.single("info", "bunny.octree", "--json").stdout)
        self.single("export", "bunny.octree", "-o", "one.runs")
        self.done(3, "export", "bunny.octree", "-o", "three.runs")
        self.assertEqual(self.sum("one.runs"), self.sum("three.runs"))


class Faults(Folder):
    @classmethod
    def prepare(cls):
        cls.single("build", os.path.join(SOURCE, "data", "bunny.stl"), "--depth", "8", "-o", "bunny.octree")
        cls.ranks(1, "export", "bunny.octree", "--raw", "-o", "bunny.nrrd")

    def test_truncated_input(self):
        with open(self.path("bunny.nrrd"), "rb") as file:
            head = file.read(1 << 23)
        with open(self.path("short.nrrd"), "wb") as file:
            file.write(head)
        self.refused(3, "build", "short.nrrd", "-o", "out.octree", part="short.nrrd: its header tells of 16777216 voxels")
        with open(self.path("short.octree"), "wb") as file, open(self.path("bunny.octree"), "rb") as whole:
            file.write(whole.read()[:-100])
        self.refused(2, "translate", "short.octree", "1,0,0", "-o", "out.octree", part="short.octree")

    def test_bad_usage(self):
        self.refused(3, "build", "bunny.nrrd", part="required")
        self.refused(2, "move", "bunny.octree", "--rotate", "0,0,0:3", "-o", "out.octree", part="axis is zero")
        self.refused(2, "move", "bunny.octree", "--translate", "500,0,0", "-o", "out.octree", part="leaves")
        self.refused(2, "fly", "bunny.octree", part="unknown command 'fly'")
        self.refused(2, "build", os.path.join(SOURCE, "data", "bunny.stl"), "-o", "out.octree", part="is no volume")
        self.refused(2, "build", ATLAS, "-o", "out.octree", part="packed")

    def test_unwritable_output(self):
        self.refused(3, "build", "bunny.nrrd", "-o", "missing/out.octree", part="there is no folder 'missing'")
        os.mkdir(self.path("taken.octree"))
        self.refused(3, "translate", "bunny.octree", "1,0,0", "-o", "taken.octree", part="it is a folder")

    def test_memory_limit(self):
        self.refused(3, "build", "bunny.nrrd", "-o", "out.octree", "--memory-limit", "64K", part="a rank of 3 needs")
        self.refused(3, "move", "bunny.octree", "--translate", "1,0,0.5", "-o", "out.octree", "--memory-limit", "1K", part="a rank of 3 needs")
        self.done(3, "build", "bunny.nrrd", "-o", "fits.octree", "--memory-limit", "1G")

    def test_one_rank_cannot_read(self):
        """The second rank does not see the file."""
        os.makedirs(self.path("elsewhere"), exist_ok=True)
        with open(self.path("elsewhere/bunny.nrrd"), "w") as file:
            file.write("NRRD0004\n")
        with open(self.path("elsewhere/part.nhdr"), "w") as file:
            file.write("NRRD0004\n")
        with open(self.path("part.nhdr"), "w") as file:
            file.write(nrrd((256, 256, 256), "uint8", "part.raw"))
        with open(self.path("part.raw"), "wb") as file:
            file.write(bytes(256 ** 3))
        before = sorted(os.listdir(self.folder))
        done = run([MPIRUN, "-n", 1, SHARED, "build", "part.nhdr", "-o", "out.octree", ":", "-n", 1, "--wdir", self.path("elsewhere"), SHARED,
                    "build", "part.nhdr", "-o", "out.octree"], cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        messages = [line for line in done.stderr.splitlines() if line.startswith("blackleaf-mpi: ")]
        self.assertEqual(len(messages), 1, done.stderr)
        self.assertIn("part.nhdr: cannot be read", messages[0])
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_full_disk(self):
        """A limit on the size of files, which the second rank meets when it writes."""
        limited = f"trap '' XFSZ; ulimit -f 1; exec '{SHARED}' export bunny.octree --raw -o full.nrrd"
        before = sorted(os.listdir(self.folder))
        done = run([MPIRUN, "--mca", "btl", "self,tcp", "--mca", "btl_tcp_if_include", "lo", "-n", 1, SHARED, "export", "bunny.octree", "--raw",
                    "-o", "full.nrrd", ":", "-n", 1, "sh", "-c", limited], cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        messages = [line for line in done.stderr.splitlines() if line.startswith("blackleaf-mpi: ")]
        self.assertEqual(len(messages), 1, done.stderr)
        self.assertIn("full.nrrd: cannot be written", messages[0])
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_a_rank_that_dies(self):
        """The third rank is killed in the middle: all end, and no file is there."""
        with open(self.path("large.nhdr"), "w") as file:
            file.write(nrrd((4096, 4096, 2048), "uint8", "large.raw"))
        with open(self.path("large.raw"), "wb") as file:
            file.truncate(4096 * 4096 * 2048)  # zeros that take no room
        words = "build large.nhdr -o out.octree"
        began = time.monotonic()
        done = run([MPIRUN, "-n", 2, SHARED, *words.split(), ":", "-n", 1, "sh", "-c",
                    f"'{SHARED}' {words} & sleep 1; kill -ABRT $!; wait $!"], cwd=self.folder)
        self.assertNotEqual(done.returncode, 0)
        self.assertLess(time.monotonic() - began, 120)
        self.assertFalse(os.path.exists(self.path("out.octree")))
        os.remove(self.path("large.raw"))

    def test_interrupt(self):
        with open(self.path("long.nhdr"), "w") as file:
            file.write(nrrd((4096, 4096, 2048), "uint8", "long.raw"))
        with open(self.path("long.raw"), "wb") as file:
            file.truncate(4096 * 4096 * 2048)
        program = subprocess.Popen([MPIRUN, "-n", "2", SHARED, "build", "long.nhdr", "-o", "out.octree"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(1.5)
        program.send_signal(signal.SIGTERM)
        program.communicate(timeout=120)
        self.assertNotEqual(program.returncode, 0)
        self.assertEqual([name for name in os.listdir(self.folder) if name == "out.octree" or name.startswith(".blackleaf")], [])
        os.remove(self.path("long.raw"))


if __name__ == "__main__":
    groups = sys.argv[6:]
    if groups == ["--table"]:
        TABLE, groups = [], ["Build.test_atlas", "Build.test_bunny_at_512", "Motion.test_move", "Motion.test_translate", "Motion.test_combine"]
    good = unittest.main(argv=[sys.argv[0], *groups], exit=False, verbosity=2).result.wasSuccessful()
    for words, count, checksum in TABLE or ():
        print(f"| `{words}` | {count} | `{checksum[:32]}` |")
    sys.exit(0 if good else 1)
