"""bench/compare [NAME...]: every figure of the benchmarks, ours beside the papers' own algorithms and the peers.

A figure has a key such as voxels/512/t1 (docs/PERFORMANCE.md lists them). NAME selects keys: a key, a pattern (voxels/*/t1),
or the beginning of keys (voxels). Without NAME all figures are made. The contenders of one key run in one process on the same
input, interleaved at random; the result is the median of the repetitions. Results go to bench/results.json; keys that were not
selected keep what they have there.
"""
import argparse
import collections
import fnmatch
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile

import demands
import mpi_figures
import tables

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
RESULTS = os.path.join(ROOT, "bench", "results.json")
TABLES = os.path.join(ROOT, "docs", "PERFORMANCE.md")
PROGRAM = os.path.join(ROOT, "build", "bench", "bench", "blackleaf_bench")
SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
COUNTERS = ("bytes", "voxels", "ratio", "s")  # what a benchmark may report itself; s are seconds


def fail(message):
    print(f"bench/compare: {message}", file=sys.stderr)
    sys.exit(2)


def build():
    for command in (["cmake", "--preset", "bench"], ["cmake", "--build", "--preset", "bench", "--target", "blackleaf_bench"]):
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            print(done.stdout, file=sys.stderr)
            fail(f"`{' '.join(command)}` failed; its output is above")


def contender_of(name):
    """KEY@WHO, then whatever Google Benchmark appends, as (key, who)."""
    found = re.fullmatch(r"([^@]+)@([^/]+)(/.*)?", name)
    return (found[1], found[2]) if found else None


def all_keys(program):
    listed = subprocess.run([program, "--benchmark_list_tests=true"], capture_output=True, text=True, check=True)
    keys = collections.OrderedDict()
    for line in listed.stdout.splitlines():
        contender = contender_of(line.strip())
        if contender:
            keys.setdefault(contender[0], []).append(contender[1])
    return keys


def select(keys, names):
    if not names:
        return list(keys)
    chosen = []
    for name in names:
        hits = [k for k in keys if k == name or fnmatch.fnmatchcase(k, name) or k.startswith(name.rstrip("/") + "/")]
        hits = hits or [k for k in keys if k.startswith(name)]
        if not hits:
            subjects = ", ".join(collections.OrderedDict((k.split("/")[0], None) for k in keys))
            fail(f"no figure is called '{name}'; names begin with one of: {subjects}")
        chosen += [k for k in hits if k not in chosen]
    return [k for k in keys if k in chosen]


def value_of(run, threads):
    """What one repetition measured: bytes, voxels, a ratio, seconds an item, or seconds.

    For one thread these are the process's CPU seconds, which equal the elapsed ones on an idle machine and leave out what
    other programs did meanwhile; for several threads they are elapsed seconds.
    """
    for unit in COUNTERS:
        if unit in run:
            return run[unit], unit
    time = (run["cpu_time"] if threads == 1 else run["real_time"]) * SECONDS[run["time_unit"]]
    if "items_per_second" in run:  # by elapsed time
        time /= run["items_per_second"] * run["real_time"] * SECONDS[run["time_unit"]]
    return time, "s"


def measure(program, key, contenders, repetitions, min_time):
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        done = subprocess.run(
            [program, f"--benchmark_filter=^{key}@", f"--benchmark_repetitions={repetitions}",
             f"--benchmark_min_time={min_time}", "--benchmark_enable_random_interleaving=true",
             f"--benchmark_out={out.name}", "--benchmark_out_format=json"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            fail(f"{key}: the benchmark failed: {done.stderr.strip().splitlines()[-1] if done.stderr.strip() else 'no message'}")
        text = out.read()
    if not text:
        fail(f"{key}: the benchmark reported nothing")
    report = json.loads(text)
    found = re.search(r"/t(\d+)$", key)
    threads = int(found[1]) if found else 1
    values, unit, edges = collections.OrderedDict(), "s", None
    for run in report["benchmarks"]:
        contender = contender_of(run["name"])
        if run.get("run_type") != "iteration" or not contender:
            continue
        if run.get("error_occurred"):
            fail(f"{run['name']}: {run.get('error_message', 'failed')}")
        value, unit = value_of(run, threads)
        values.setdefault(contender[1], []).append(value)
        edges = int(run.get("edges", 0)) or edges  # of a drawing: unit feature edges of its solid
    digits = 4 if unit == "s" else 12  # what is counted is exact
    medians = {who: float(f"{statistics.median(v):.{digits}g}") for who, v in sorted(values.items(), key=lambda item: contenders.index(item[0]))}
    result = {who: medians.pop(who) for who in ("ours", "ours_p95") if who in medians}
    if edges:
        result["edges"] = edges
    return {**result, "peers": medians, "unit": unit, "threads": threads}


def ratio(value, ours):
    return f"{value / ours:.3g}" if ours else "-"


def print_rows(key, result):
    ours = tables.shown(result["ours"], result["unit"])
    if not result["peers"]:
        print(f"{key:24} {ours:>14}")
    for who, value in result["peers"].items():
        beside = tables.beside(result, who)
        print(f"{key:24} {tables.shown(beside, result['unit']):>14}  {who:12} {tables.shown(value, result['unit']):>14} {ratio(value, beside):>10}")
    sys.stdout.flush()


def in_order(results, keys):
    """As the program lists them, whatever order they were made in."""
    return {key: results[key] for key in keys if key in results}


def write(results, keys):
    lines = [f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in in_order(results, keys).items()]
    temporary = RESULTS + ".new"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write("{\n" + ",\n".join(lines) + "\n}\n")
    os.replace(temporary, RESULTS)


def stored_results():
    if not os.path.exists(RESULTS):
        return {}
    with open(RESULTS, encoding="utf-8") as file:
        try:
            return json.load(file)
        except ValueError:
            fail(f"{RESULTS} is not JSON; remove it")


def measured_results(options):
    """The stored results with the chosen figures made anew; None if they were only to be listed."""
    if options.names and all(name.split("/")[0] == "mpi" for name in options.names):
        keys = collections.OrderedDict((key, []) for key in stored_results())  # the other programs are not needed
    else:
        if not options.program:
            build()
        program = options.program or PROGRAM
        if not os.access(program, os.X_OK):
            fail(f"{program} is not a program")
        keys = all_keys(program)
    keys.update(mpi_figures.KEYS)
    chosen = select(keys, options.names)
    if options.list:
        for key in chosen:
            print(f"{key:24} {' '.join(keys[key])}")
        return None
    results = {k: v for k, v in stored_results().items() if k in keys}  # without keys that are gone
    print(f"{'figure':24} {'ours':>14}  {'peer':12} {'its':>14} {'peer/ours':>10}")
    of_ranks = [key for key in chosen if key in mpi_figures.KEYS]
    for key, result in mpi_figures.measure(of_ranks, options.repetitions).items() if of_ranks else ():
        results[key] = result
        print_rows(key, result)
        write(results, keys)
    for key in chosen:
        if key in of_ranks:
            continue
        results[key] = measure(program, key, keys[key], options.repetitions, options.min_time)
        print_rows(key, results[key])
        write(results, keys)
    return in_order(results, keys)


def main():
    parser = argparse.ArgumentParser(prog="bench/compare", description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--repetitions", type=int, default=5, help="how often each contender runs (default 5)")
    parser.add_argument("--min-time", default="0.05", help="seconds a repetition lasts at least (default 0.05)")
    parser.add_argument("--list", action="store_true", help="print the keys and who competes for them, and stop")
    parser.add_argument("--program", help="a blackleaf_bench that is built already: nothing is installed or built")
    parser.add_argument("--stored", action="store_true", help="measure nothing: take bench/results.json as it is")
    parser.add_argument("--table", action="store_true", help="write the tables of docs/PERFORMANCE.md anew")
    parser.add_argument("--check", action="store_true", help="tell which demands (bench/demands.py) hold; status 1 if one does not")
    options = parser.parse_args()
    if options.repetitions < 1:
        fail("--repetitions must be at least 1")
    if options.stored and (options.names or options.list):
        fail("--stored goes with --table and --check only")
    results = stored_results() if options.stored else measured_results(options)
    if results is None:
        return
    if options.table:
        tables.write(TABLES, results)
    if options.check:
        lines, all_hold = demands.report(results)
        print("\n".join(lines))
        sys.exit(0 if all_hold else 1)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
