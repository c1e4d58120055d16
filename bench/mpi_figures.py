"""The figures mpi/... of bench/compare: blackleaf-mpi with one and two ranks, beside blackleaf, one thread each.

The input is made once, in build/bench/mpi: a ball with pores, 1024 voxels a side, as a raw volume of 1 GiB and as an octree.
What counts is the elapsed time of the stage that does the work, "build" (reading included) or "move", as --timings tells it:
starting MPI takes half a second and is no work of ours. The programs take turns; the result is the median.
"""
import json
import os
import statistics
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILT = os.path.join(ROOT, "build", "bench")
FOLDER = os.path.join(BUILT, "mpi")
KEYS = {f"mpi/{work}/1024/n{ranks}": ["ours", "blackleaf"] for work in ("build", "move") for ranks in (1, 2)}
MPIRUN = ["mpirun", "--oversubscribe", "--mca", "btl", "self,vader", "--mca", "pml", "ob1", "--mca", "btl_vader_single_copy_mechanism", "none"]


def run(words, **more):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    done = subprocess.run(words, cwd=FOLDER, stdin=subprocess.DEVNULL, capture_output=True, text=True, env=environment, **more)
    if done.returncode:
        raise SystemExit(f"bench/compare: `{' '.join(words)}` failed: {done.stderr.strip()}")
    return done


def prepare():
    os.makedirs(FOLDER, exist_ok=True)
    run(["cmake", "--preset", "bench", "-S", ROOT])
    run(["cmake", "--build", BUILT, "--target", "blackleaf_cli", "blackleaf_mpi_program", "make_foam"])
    if not os.path.exists(os.path.join(FOLDER, "foam.octree")):
        run([os.path.join(BUILT, "bench", "make_foam"), "10", "foam.octree"])
    if not os.path.exists(os.path.join(FOLDER, "foam.nrrd")):
        run([os.path.join(BUILT, "blackleaf"), "export", "foam.octree", "--raw", "-o", "foam.nrrd"])
    with open(os.path.join(FOLDER, "foam.nrrd"), "rb", buffering=0) as file:  # into the page cache
        while file.read(1 << 24):
            pass


def stage(program, work):
    words = {"build": ["build", "foam.nrrd"],
             "move": ["move", "foam.octree", "--rotate", "1,1,1:30", "--translate", "5.3,-7.1,2.9", "--about", "centre"]}[work]
    done = run([*program, *words, "-o", "out.octree", "--threads", "1", "--quiet", "--timings"])
    return json.loads([line for line in done.stderr.splitlines() if line.startswith("{")][-1])[work]


def measure(chosen, repetitions):
    """{key: result} of the chosen keys."""
    prepare()
    shared = os.path.join(BUILT, "blackleaf-mpi")
    results = {}
    for work in ("build", "move"):
        keys = {ranks: f"mpi/{work}/1024/n{ranks}" for ranks in (1, 2)}
        if not set(keys.values()) & set(chosen):
            continue
        seconds = {"blackleaf": [], 1: [], 2: []}
        for _ in range(repetitions):
            seconds["blackleaf"].append(stage([os.path.join(BUILT, "blackleaf")], work))
            for ranks in (1, 2):
                seconds[ranks].append(stage([*MPIRUN, "-n", str(ranks), shared], work))
        median = {who: float(f"{statistics.median(values):.4g}") for who, values in seconds.items()}
        for ranks, key in keys.items():
            if key in chosen:
                results[key] = {"ours": median[ranks], "peers": {"blackleaf": median["blackleaf"]}, "unit": "s", "threads": 1}
    return results
