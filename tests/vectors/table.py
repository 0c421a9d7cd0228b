#!/usr/bin/env python3
"""Every seeded bug against the vectors that catch it, as Markdown.

table.py SHAPEID [FOLDER]: the command shapeid, and the folder of the vectors if not this one. Exit
status 1 if a bug is caught by nothing.
"""
import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

sys.dont_write_bytecode = True
import bugs  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))


def caught(bug):
    """Of every kind: how many of its vectors fail, and how many there are."""
    program = [sys.executable, os.path.join(HERE, "bugs.py"), bug]
    run = subprocess.run([SHAPEID, "vectors", "--json", "--vectors", FOLDER, "--check",
                          shlex.join(program)], capture_output=True, text=True)
    if run.returncode not in (0, 1):
        sys.exit(f"{bug}: {run.stderr}")
    kinds = json.loads(run.stdout)["kinds"]
    return {kind: (tally["failed"], tally["cases"]) for kind, tally in kinds.items()}


def main():
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = dict(zip(bugs.BUGS, pool.map(caught, bugs.BUGS)))
    cases = {kind: count for kind, (_, count) in next(iter(found.values())).items()}
    kinds = [kind for kind in bugs.good.ANSWERS if kind in cases]
    print(INTRODUCTION)
    print("| bug | " + " | ".join(kinds) + " |")
    print("|---|" + "---:|" * len(kinds))
    print("| *vectors* | " + " | ".join(f"*{cases[kind]}*" for kind in kinds) + " |")
    for bug, tallies in found.items():
        print(f"| {bug} | " + " | ".join(str(tallies[kind][0] or "") for kind in kinds) + " |")
    missed = [bug for bug, tallies in found.items() if not any(f for f, _ in tallies.values())]
    print(f"\n{len(found)} bugs, {len(missed)} caught by nothing"
          + "".join(f"; {bug}" for bug in missed) + ".")
    sys.exit(1 if missed else 0)


INTRODUCTION = """# Seeded bugs

One bug at a time in [the example program](examples/vectors.py), and how many vectors of each kind it fails: what
`shapeid vectors --check` finds in an implementation that is nearly right. The bugs are planted by
[tests/vectors/bugs.py](../tests/vectors/bugs.py); `./run vectors` writes this page, and a test writes it again and
compares. A bug that shows in a kind with one case only is caught by an edge case made for it.
"""

SHAPEID = sys.argv[1] if len(sys.argv) > 1 else "shapeid"
FOLDER = sys.argv[2] if len(sys.argv) > 2 else HERE

if __name__ == "__main__":
    main()
