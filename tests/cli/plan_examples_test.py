#!/usr/bin/env python3
"""Runs the commands of examples/plan/README.md, plans once more with other seeds, and checks every path.

usage: plan_examples_test.py PROGRAM SOURCE_FOLDER
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

MOST_SECONDS = 400  # a command, under sanitizers
SEEDS = ("2", "3")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, source = (os.path.abspath(argument) for argument in sys.argv[1:])
    examples = os.path.join(source, "examples", "plan")
    with open(os.path.join(examples, "README.md"), encoding="utf-8") as file:
        commands = [line for block in re.findall(r"```sh\n(.*?)```", file.read(), re.DOTALL) for line in block.splitlines()]
    problems = []
    paths = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in ("make_scenes.py", "scale_stl.py"):
            shutil.copy(os.path.join(examples, name), folder)
        shutil.copy(os.path.join(source, "data", "bunny.stl"), folder)

        def run(words, good=(0,)):
            if words[0] == "blackleaf":
                words = [program] + words[1:]
            elif words[0] == "python3":
                words = [sys.executable] + words[1:]
            done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=MOST_SECONDS, check=False)
            if done.returncode not in good:
                problems.append(f"status {done.returncode}: {' '.join(words)}\n{done.stdout}")
            return done.stdout

        def value_of(words, option):
            return [words[i + 1] for i, word in enumerate(words) if word == option]

        def check(words):
            """Every path of a plan: what its file says, and that no voxel of its sweep is one of the environment's."""
            for solid, path in zip(value_of(words, "--object"), value_of(words, "-o")):
                with open(os.path.join(folder, path), encoding="utf-8") as file:
                    content = json.load(file)
                least = min(pose["clearance"] for pose in content["poses"])
                if content["verified"] is not True or not least > 0:
                    problems.append(f"{path}: verified {content['verified']}, clearance {least}")
                run(["blackleaf", "sweep", solid, "--path", path, "-o", "swept.octree", "--quiet"])
                environment = value_of(words, "--environment")[0]
                common = json.loads(run(["blackleaf", "combine", environment, "and", "swept.octree", "-o", "common.octree",
                                         "--json", "--quiet"]))
                if common["volume"] != 0:
                    problems.append(f"{path}: {common['volume']} voxels of the way are in {environment}")

        for command in commands:
            words = command.split()
            absent = [word for word in words if word.startswith("/usr") and not os.path.exists(word)]
            if absent:
                print("passed over, there is no " + absent[0])
                break
            told = run(words)
            if words[1] != "plan":
                continue
            print(told, end="", flush=True)
            check(words)
            for seed in SEEDS:
                run(words + ["--seed", seed])
                check(words)
            paths += (1 + len(SEEDS)) * len(value_of(words, "--object"))
    if paths == 0:
        problems.append("no path was planned: the test no longer finds the examples")
    print("\n".join(problems))
    print(f"{paths} paths, {len(problems)} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
