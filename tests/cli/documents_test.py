#!/usr/bin/env python3
"""Runs the commands that the documents show and compares what they print with what stands below them.

usage: documents_test.py PROGRAM SOURCE_FOLDER [--update]

docs/COMMAND_LINE.md: lines "    $ COMMAND" are run in their order in one folder, and the indented lines that follow
must be what they print; "$ cat FILE" makes a file that is not there. README.md: commands of its ```sh blocks that begin with "blackleaf" must succeed. With --update,
what is printed takes the place of what stood in COMMAND_LINE.md.
"""
import difflib
import gzip
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

SHOWN = re.compile(r"    \$ (.*)")
MOST_SECONDS = 300  # a command, under sanitizers


def run(command, folder, program):
    """Output and errors of a command, as a terminal would show them, and its exit status."""
    path = os.path.dirname(os.path.abspath(program)) + os.pathsep + os.environ["PATH"]
    done = subprocess.run(command, shell=True, cwd=folder, env=dict(os.environ, PATH=path), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=MOST_SECONDS, check=False)
    return done.stdout.rstrip("\n").split("\n") if done.stdout.strip() else [], done.returncode


def missing(command):
    """A program that is not installed here, or a file outside the folder that is not, or None."""
    name = command.split()[0]
    if name != "blackleaf" and not shutil.which(name):
        return name
    outside = re.findall(r"(?<=\s)/\S+", command)
    return next((name for name in outside if not os.path.exists(name)), None)


def check_command_line(document, source, folder, program, update):
    """The number of examples and that of those which print something else."""
    for name in ("bunny.stl", "beam.stl"):
        shutil.copy(os.path.join(source, "data", name), folder)
    shutil.copy(os.path.join(source, "examples", "plan", "make_scenes.py"), folder)
    subprocess.run([sys.executable, os.path.join(source, "examples", "va88", "make_silhouettes.py"), folder], check=True,
                   stdout=subprocess.DEVNULL)
    with open(document, encoding="utf-8") as file:
        lines = file.read().split("\n")
    given = re.search(r"`quarter\.txt` with `([^`]*)`", "\n".join(lines))
    with open(os.path.join(folder, "quarter.txt"), "w", encoding="utf-8") as file:
        file.write(given[1])

    result, absent, examples, wrong = [], set(), 0, 0
    at = 0
    while at < len(lines):
        example = SHOWN.match(lines[at])
        result.append(lines[at])
        at += 1
        if not example:
            continue
        examples += 1
        command, told = example[1], []
        while at < len(lines) and lines[at].startswith("    ") and not SHOWN.match(lines[at]):
            told.append(lines[at][4:])
            at += 1
        shown = re.fullmatch(r"cat (\S+)", command)
        if shown and not os.path.exists(os.path.join(folder, shown[1])):  # a file of the reader's own
            with open(os.path.join(folder, shown[1]), "w", encoding="utf-8") as file:
                file.write("\n".join(told) + "\n")
        unknown = missing(command) or next((name for name in absent if name in command.split()), None)
        if unknown:
            print(f"passed over, there is no {unknown}: {command}")
            absent.update(re.findall(r"-o (\S+)", command))
            printed = told
        else:
            printed = run(command, folder, program)[0]
        if printed != told:
            wrong += 1
            print(f"{document}:{len(result)}: $ {command}")
            print("\n".join(difflib.unified_diff(told, printed, "told", "printed", lineterm="")))
        result += ["    " + line for line in printed]
    if update and wrong:
        with open(document, "w", encoding="utf-8") as file:
            file.write("\n".join(result))
    return examples, wrong


def write_scan(path):
    """A NIfTI volume of 64^3 16-bit values: a ball of 1000."""
    side = 64
    header = struct.pack("<i36x8h", 348, 3, side, side, side, 1, 1, 1, 1) + bytes(14)
    header += struct.pack("<hhh8f", 4, 16, 0, 1, 1, 1, 1, 1, 1, 1, 1)
    header = (header + struct.pack("<f2f", 352, 1, 0)).ljust(344, b"\0") + b"n+1\0" + bytes(4)
    middle = (side - 1) / 2
    values = (1000 if (x - middle) ** 2 + (y - middle) ** 2 + (z - middle) ** 2 < 400 else 0
              for z in range(side) for y in range(side) for x in range(side))
    with gzip.open(path, "wb") as file:
        file.write(header + struct.pack(f"<{side ** 3}h", *values))


def check_readme(document, folder, program):
    """The same numbers. The scan and the tool that the README speaks of are stand-ins."""
    write_scan(os.path.join(folder, "skull.nii.gz"))
    run("blackleaf build bunny.stl --depth 6 -o tool.octree", folder, program)
    with open(document, encoding="utf-8") as file:
        blocks = re.findall(r"```sh\n(.*?)```", file.read(), re.DOTALL)
    commands = [line for block in blocks for line in block.split("\n") if line.startswith("blackleaf ")]
    wrong = 0
    for command in commands:
        printed, status = run(command, folder, program)
        if status not in ((0, 1) if " collide " in command else (0,)):
            wrong += 1
            print(f"{document}: {command}", *printed, sep="\n")
    return len(commands), wrong


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--update"]
    if len(arguments) != 2:
        sys.exit(__doc__)
    program, source = arguments
    examples = wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for found in (check_command_line(os.path.join(source, "docs", "COMMAND_LINE.md"), source, folder, program,
                                         "--update" in sys.argv),
                      check_readme(os.path.join(source, "README.md"), folder, program)):
            if found[0] == 0:
                sys.exit("a document shows no commands: the test no longer finds them")
            examples, wrong = examples + found[0], wrong + found[1]
    print(f"{examples} commands, {wrong} of them not as the documents say")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
