"""Which test kills which mutant."""
import collections
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time

SLOW = 3.0  # seconds: such tests come last
ALONE = 3  # tests that are asked one by one
TOGETHER = 2.0  # seconds of tests that are asked in one process
# What a contract, an array of the standard library's and one of Eigen's say before they end a program.
CHECKS = re.compile(r"contract broken|: Assertion [`']")
# A mutant may ask for anything. One test makes a file of 10 GiB, a hole from end to end.
LIMITS = ("prlimit", "--as=6000000000", "--fsize=11000000000", "--core=0")


def run(program, tests, seconds, **variables):
    """Runs tests of one program. Its exit status, or None after `seconds`; the test that failed, or ran
    last; how long all took; whether a contract or a bound did not hold."""
    scratch = tempfile.mkdtemp(prefix="mutant-")
    seeds = {"RC_PARAMS": "seed=20240611 noshrink=1", "TMPDIR": scratch}
    began = time.monotonic()
    said = pathlib.Path(scratch) / "said"
    with open(said, "wb") as out:
        process = subprocess.Popen([*LIMITS, program, "--gtest_filter=" + ":".join(tests)], cwd=program.parent,
                                   stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=subprocess.STDOUT, start_new_session=True,
                                   env=os.environ | seeds | variables)
    try:
        status = process.wait(seconds)
    except subprocess.TimeoutExpired:
        status = None
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)  # and what it started
        except ProcessLookupError:
            pass
        process.wait()
        text = said.read_text(errors="replace")
        failed = re.findall(r"^\[  FAILED  \] ([\w./]+)", text, re.M)
        begun = re.findall(r"^\[ RUN      \] (\S+)", text, re.M)
        shutil.rmtree(scratch, ignore_errors=True)
    is_check = CHECKS.search(text) is not None
    return status, [*failed[:1], *reversed(begun), tests[0]][0], time.monotonic() - began, is_check


def in_parallel(work, items, jobs):
    """Calls work(item) for every item, in order, on `jobs` threads."""
    waiting, failures = collections.deque(items), []

    def worker():
        while waiting and not failures:
            try:
                work(waiting.popleft())
            except IndexError:
                return
            except BaseException as failure:
                failures.append(failure)

    threads = [threading.Thread(target=worker) for _ in range(jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]


def tests_of(program):
    """Names of the tests of a program."""
    listed = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True)
    names, suite = [], ""
    for line in listed.stdout.splitlines():
        word = line.split("#")[0].rstrip()
        if word.startswith("  "):
            names.append(suite + word.strip())
        elif word.endswith("."):
            suite = word
    return names


def passed_by(programs, kept, jobs):
    """For every test: its program, its seconds, and the mutants that it comes past. Tests that fail
    although no mutant lives are left out, and returned by name. `kept` (a file) remembers what was
    measured of a program until it changes."""
    known = json.loads(kept.read_text()) if kept.exists() else {}
    lock = threading.Lock()

    def measure(item):
        program, test = item
        passed = pathlib.Path(tempfile.mkstemp(prefix="passed-")[1])
        status, _, seconds, _ = run(program, [test], 900, SHAPEID_PASSED=str(passed))
        numbers = sorted({int(line) for line in passed.read_text().split()})
        passed.unlink()
        with lock:
            measured[test] = {"status": status, "seconds": seconds, "passed": numbers}

    for program in programs:
        stamp = hashlib.sha256(program.read_bytes()).hexdigest()
        if known.get(program.name, {}).get("stamp") == stamp:
            continue
        measured = {}
        in_parallel(measure, [(program, test) for test in tests_of(program)], jobs)
        known[program.name] = {"stamp": stamp, "tests": measured}
        kept.write_text(json.dumps(known))
    places = {program.name: program for program in programs}
    good, failing = {}, []
    for name in places:
        for test, record in known[name]["tests"].items():
            if record["status"] == 0:
                good[test] = {"program": places[name], **record}
            else:
                failing.append(test)
    return good, failing


class Campaign:
    """Runs the tests that come past a mutant until one fails; appends each verdict to a file."""

    def __init__(self, tests, results, budget):
        self.tests, self.results, self.budget = tests, results, budget
        self.reaching = collections.defaultdict(list)
        for name, test in tests.items():
            for number in test["passed"]:
                self.reaching[number].append(name)
        self.killers = collections.defaultdict(collections.Counter)  # by file
        self.asked_before = collections.defaultdict(list)  # by key: the tests that a mutant survived
        self.lock = threading.Lock()

    def order(self, number, key, file):
        """First what was not asked before, then what killed most mutants of this file, then the quick
        ones."""
        kills, before = self.killers[file], set(self.asked_before[key])

        def rank(name):
            seconds = self.tests[name]["seconds"]
            return (name in before, seconds > SLOW, -kills[name], seconds)

        return sorted(self.reaching[number], key=rank)

    def rounds(self, names):
        """Tests of one program together, a few seconds of them: a process takes time to start. The
        first ones, most likely to kill, alone. Not what would exceed the budget."""
        together, spent = [], 0.0
        for at, name in enumerate(names):
            test = self.tests[name]
            if spent + test["seconds"] > self.budget and at > 0:
                continue
            spent += test["seconds"]
            for group in together[ALONE:]:
                if group["program"] == test["program"] and group["seconds"] + test["seconds"] < TOGETHER:
                    break
            else:
                group = {"program": test["program"], "names": [], "seconds": 0.0}
                together.append(group)
            group["names"].append(name)
            group["seconds"] += test["seconds"]
        return together

    def judge(self, item):
        number, key, file = item
        with self.lock:
            names = self.order(number, key, file)
        verdict = {"key": key, "verdict": "survived" if names else "not reached", "asked": []}
        began = time.monotonic()
        for group in self.rounds(names):
            status, last, _, is_check = run(group["program"], group["names"], 2.0 + 10.0 * group["seconds"],
                                            SHAPEID_MUTANT=str(number), GTEST_FAIL_FAST="1")
            verdict["asked"] += group["names"]
            if status != 0:
                how = "too long" if status is None else "failed" if status == 1 else f"status {status}"
                verdict |= {"verdict": "killed", "by": last, "how": how, "check": is_check}
                break
        verdict |= {"tried": len(verdict["asked"]), "reaching": len(names),
                    "seconds": round(time.monotonic() - began, 2)}
        with self.lock:
            if verdict["verdict"] == "killed":
                del verdict["asked"]
                self.killers[file][verdict["by"]] += 1
            with open(self.results, "a", encoding="utf-8") as out:
                out.write(json.dumps(verdict) + "\n")
