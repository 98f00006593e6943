"""Do the unit tests notice a wrong operator, comparison or constant?   (see CONTRIBUTING.md)

    python tests/mutation --build build/release --group topology --count 100

changes one at a time in a copy of a source, compiles that copy alone (unoptimised), links the
group's test programs anew with it in place of the library's own object, and runs them until one
fails. Survivors are printed as changed lines, and the results kept, so that a second call goes on.
"""

import argparse
import json
import pathlib
import random
import re
import resource
import shlex
import subprocess
import sys
import tempfile

from mutants import mutants_of

ROOT = pathlib.Path(__file__).resolve().parents[2]

# What is changed, and the programs that have to notice; the fastest first.
GROUPS = {
    "scheduler": ("scheduler/*.cpp",
                  ["trials", "task_graph", "cost_model", "plan_adaptations", "exchange_map",
                   "planners", "plan_allocations"]),
    "topology": ("simulation/topology/*.cpp", ["topology"]),
    "planning": ("runtime/planning/*.cpp",
                 ["planning", "library", "async_choice", "async_convergence", "device_loss"]),
    "runtime": ("runtime/*.cpp", ["runtime", "executor", "device_loss", "library"]),
}
MEMORY = 4 << 30  # bytes; a loop without an end may ask for all there is


class Bench:
    """Compiles, links and runs mutants with the commands of a finished build."""

    def __init__(self, build, programs, folder):
        self.build, self.folder = build, pathlib.Path(folder)
        entries = json.loads((build / "compile_commands.json").read_text())
        self.compile_commands = {e["file"]: (e["directory"], e["command"]) for e in entries}
        self.programs = {name: self._link_command(name) for name in programs}
        self.limits = {}  # seconds of processor time; unoptimised code is slower
        for name in programs:
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            if self._fails(build / "bin" / f"test_{name}", 600):
                sys.exit(f"mutation: test_{name} fails as it is")
            used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
            self.limits[name] = int(4 * used + 3)

    def _link_command(self, name):
        commands = subprocess.run(["ninja", "-C", self.build, "-t", "commands", f"bin/test_{name}"],
                                  check=True, capture_output=True, text=True).stdout
        return re.search(r"&& (.*?) &&", commands.strip().splitlines()[-1]).group(1)

    def _fails(self, program, seconds):
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        try:
            return subprocess.run([program, "--gtest_fail_fast", "--gtest_brief=1"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  preexec_fn=limit, cwd=self.folder,
                                  timeout=60 + 20 * seconds).returncode != 0
        except subprocess.TimeoutExpired:
            return True

    def _compiles(self, source, copy, built):
        directory, command = self.compile_commands[str(source)]
        words = shlex.split(command)
        if words[0].endswith("ccache"):
            words = words[1:]
        dropped = {"-c", "-o", "-MD", "-MT", "-MF", str(source)}
        words = [w for w in words if w not in dropped and not re.match(r"-O|-W|.*\.cpp\.o", w)]
        return subprocess.run(words + ["-w", "-O0", "-c", str(copy), "-o", str(built)],
                              cwd=directory, capture_output=True).returncode == 0

    def verdict(self, source, text):
        """'stillborn' (does not compile), 'survived', or the program that noticed."""
        copy, built = self.folder / source.name, self.folder / "mutant.o"
        copy.write_text(text)
        if not self._compiles(source, copy, built):
            return "stillborn"
        for name, command in self.programs.items():
            program = self.folder / f"test_{name}"
            link = command.replace(f"-o bin/test_{name}", f"-o {program} {built}")
            subprocess.run(shlex.split(link), cwd=self.build, check=True, capture_output=True)
            if self._fails(program, self.limits[name]):
                return name
        return "survived"


def main():
    options = _parse()
    build = options.build.resolve()
    results = options.results or build / "mutation.jsonl"
    known = results.read_text().splitlines() if results.exists() else []
    done = {_key(record): record for record in map(json.loads, known)}
    pattern, programs = GROUPS[options.group]
    chosen = [(source, mutant, _record(source, mutant))
              for source, mutant in _choose(pattern, options.count, options.seed)]
    with tempfile.TemporaryDirectory() as folder, results.open("a") as log:
        bench = Bench(build, programs, folder)
        for source, mutant, record in chosen:
            if _key(record) in done:
                continue
            record["verdict"] = bench.verdict(source, mutant.applied_to(source.read_text()))
            done[_key(record)] = record
            log.write(json.dumps(record) + "\n")
            log.flush()
    _report([done[_key(record)] for _, _, record in chosen])


def _choose(pattern, count, seed):
    everything = [(source, mutant) for source in sorted(ROOT.glob(pattern))
                  for mutant in mutants_of(source.read_text())]
    random.Random(seed).shuffle(everything)
    return everything[:count]


def _record(source, mutant):
    text = source.read_text()
    return {"file": str(source.relative_to(ROOT)), "line": mutant.line,
            "before": _line(text, mutant.begin),
            "after": _line(mutant.applied_to(text), mutant.begin)}


def _line(text, place):
    begin = text.rfind("\n", 0, place) + 1
    return text[begin:text.index("\n", place)].strip()


def _key(record):
    return (record["file"], record["before"], record["after"])


def _reasons():
    """Survivors that change nothing that could be noticed: (file, changed line) -> why."""
    lines = (pathlib.Path(__file__).parent / "accepted.txt").read_text().splitlines()
    rows = [line.split(" :: ") for line in lines if line and not line.startswith("#")]
    return {(file, after): reason for file, after, reason in rows}


def _report(records):
    reasons = _reasons()
    born = [r for r in records if r["verdict"] != "stillborn"]
    survivors = [r for r in born if r["verdict"] == "survived"]
    unexplained = [r for r in survivors if (r["file"], r["after"]) not in reasons]
    killed = len(born) - len(survivors)
    print(f"{len(born)} mutants ({len(records) - len(born)} more did not compile): {killed} killed, "
          f"{len(survivors)} survived, {len(survivors) - len(unexplained)} of these with a reason; "
          f"{100 * killed / max(1, len(born)):.1f} % killed")
    for r in unexplained:
        print(f"{r['file']}:{r['line']}\n  - {r['before']}\n  + {r['after']}")


def _parse():
    parser = argparse.ArgumentParser(prog="python tests/mutation",
                                     description="Runs the unit tests on slightly wrong sources.")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release",
                        help="a build with tests, up to date (default: build/release)")
    parser.add_argument("--group", choices=GROUPS, required=True)
    parser.add_argument("--count", type=int, default=100, help="mutants, chosen by chance")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--results", type=pathlib.Path, help="default: mutation.jsonl in the build")
    return parser.parse_args()


if __name__ == "__main__":
    main()
