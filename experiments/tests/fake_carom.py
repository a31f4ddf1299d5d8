"""Stands in for the carom program: same command line, same exit codes, same records, no discs.

The environment says what goes wrong: FAKE_SECONDS (each measurement takes that long), FAKE_CHECK_SECONDS
(each check), FAKE_CHECK_FAILS, FAKE_BENCH_CRASHES,
FAKE_RESULT_WRONG, FAKE_NO_RECORD, FAKE_HANGS (the variant concerned), FAKE_SUSPENDED (the verb concerned;
only as often as the file FAKE_SUSPENSIONS has lines, if there is one), FAKE_LIMITS_FAIL.
FAKE_LOG is a file that gets a line for every call, FAKE_SPANS one that gets a line for every call that
computes: its verb, when it began and when it ended. FAKE_IDLE is a word: of processes, those with it among
theirs do nothing for most of their time.
"""

import hashlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

Options = dict[str, Any]

VARIANTS = ["published", "nine", "row", "track"]


def main(words: list[str]) -> int:
    note(words)
    began = time.monotonic()
    code = answer(words)
    if "FAKE_SPANS" in os.environ and words[0] not in ("list", "generate"):
        with Path(os.environ["FAKE_SPANS"]).open("a", encoding="utf-8") as file:
            file.write(f"{words[0]} {began} {time.monotonic()}\n")
    return code


def answer(words: list[str]) -> int:
    if os.environ.get("FAKE_SUSPENDED") == words[0] and is_still_suspended():
        said = "was suspended for some time while it was measured; measure it again"
        print(f"carom: {words[1]}: {said}", file=sys.stderr)
        return 1
    if words[0] == "turns":
        return take_turns(words)
    if words[0] == "processes":
        return sample()
    if words[0] == "list":
        print("\n".join(VARIANTS))
        return 0
    return answer_with(words[0], *split(words[1:]))


def take_turns(words: list[str]) -> int:
    """As if each had its process for itself; all their records are one."""
    target = split(words[2:])[0]["record"]
    code, found = 0, []
    for said in contenders(words):
        own = f"{target}.own"
        code = max(code, answer([*said, "--record", own]))
        if not Path(own).exists():
            return code
        found.append(json.loads(Path(own).read_text(encoding="utf-8")))
        Path(own).unlink()
    whole = found[0] | {"contenders": [one for record in found for one in record["contenders"]]}
    write(target, json.dumps(whole))
    return code


def is_still_suspended() -> bool:
    if "FAKE_SUSPENSIONS" not in os.environ:
        return True
    path = Path(os.environ["FAKE_SUSPENSIONS"])
    left = path.read_text(encoding="utf-8").splitlines()
    write(str(path), "".join(f"{line}\n" for line in left[1:]))
    return bool(left)


def answer_with(verb: str, options: Options, positional: list[str]) -> int:
    if verb == "generate":
        words = [*positional, options["seed"]] if positional else ["3", "100", "5", "10", options["case"]]
        write(options["output"], "".join(f"{word}\n" for word in words))
    elif verb == "check":
        time.sleep(float(os.environ.get("FAKE_CHECK_SECONDS", "0")))
        if "trajectory" in options:
            wrong = "wrong" in Path(options["trajectory"]).read_text(encoding="utf-8")
            print("step 1: disc 0 is elsewhere" if wrong else "", file=sys.stderr)
            return 2 if wrong else 0
        if concerns("FAKE_CHECK_FAILS", options):
            print("step 3: discs 1 and 2 left colliding", file=sys.stderr)
            return 2
    elif verb in ("bench", "profile"):
        return measure(verb, positional[0], options)
    elif verb == "limits":
        return measure_limits(options)
    else:
        print(f'found "{verb}", expected a verb', file=sys.stderr)
        return 1
    return 0


def measure_limits(options: Options) -> int:
    if "FAKE_LIMITS_FAIL" in os.environ:
        print("--threads: found 2, but OpenMP grants 1", file=sys.stderr)
        return 1
    time.sleep(float(os.environ.get("FAKE_SECONDS", "0")))
    write(options["record"], json.dumps(make_limits(options)))
    return 0


def measure(verb: str, scene: str, options: Options) -> int:
    time.sleep(float(os.environ.get("FAKE_SECONDS", "0")))
    if concerns("FAKE_HANGS", options):
        time.sleep(600)
    if concerns("FAKE_BENCH_CRASHES", options):
        print("out of memory", file=sys.stderr)
        os.abort()
    wrong = concerns("FAKE_RESULT_WRONG", options)
    if not concerns("FAKE_NO_RECORD", options):
        record = make_record(verb, scene, options, wrong)
        scratch = options["record"] + ".part"
        write(scratch, json.dumps(record))
        if "timeline" in options:
            write(options["timeline"], json.dumps({"chunks": options["timeline-chunks"], "traceEvents": []}))
        Path(scratch).replace(options["record"])
    return 2 if wrong else 0


def split(rest: list[str]) -> tuple[Options, list[str]]:
    options: Options = {}
    positional: list[str] = []
    tags: dict[str, str | int | float] = {}
    words = iter(rest)
    for word in words:
        if word == "--tag":
            key, _, value = next(words).partition("=")
            tags[key] = number_or_text(value)
        elif word in ("--timeline-chunks", "--errors", "--simulated", "--isotropic"):
            options[word[2:]] = True
        elif word.startswith("--"):
            options[word[2:]] = next(words)
        else:
            positional.append(word)
    return {**options, "tags": tags}, positional


def number_or_text(value: str) -> str | int | float:
    try:
        number = json.loads(value)
    except ValueError:
        return value
    return number if isinstance(number, int | float) and not isinstance(number, bool) else value


def concerns(name: str, options: Options) -> bool:
    return os.environ.get(name) == options.get("variant")


def note(words: list[str]) -> None:
    if "FAKE_LOG" in os.environ:
        with Path(os.environ["FAKE_LOG"]).open("a", encoding="utf-8") as file:
            openmp = {
                key: value for key, value in os.environ.items() if key.startswith(("OMP_", "GOMP_", "KMP_"))
            }
            for call in [words, *contenders(words)]:
                file.write(json.dumps({"pid": os.getpid(), "words": call, "openmp": openmp}) + "\n")


def contenders(words: list[str]) -> list[list[str]]:
    """What those who take turns would be told alone."""
    if words[0] != "turns":
        return []
    runs = ["--repetitions", split(words[1:])[0].get("runs", "1")]
    return [["bench", *said, *runs] for said in json.loads(Path(words[1]).read_text(encoding="utf-8"))]


def sample() -> int:
    """Answer each line of standard input: what became of its processes, or what the machine is."""
    for line in sys.stdin:
        asked = json.loads(line)
        if "processes" in asked:
            told: Any = [facts(one) for one in asked["processes"]]
        else:
            told = {"provenance": provenance(), "scene": asked["scene"] and scene_of(asked["scene"])}
        print(json.dumps(told), flush=True)
    return 0


def facts(one: Options) -> Options:
    """Run a process; all of them take as long."""
    note(["process", *one["command"]])
    seconds = 0.01
    texts = "not_started unknown suspended went_on output_end error_end memory_of"
    numbers = (
        "exit_code signal seconds_left_behind seconds_alone system_seconds waited_seconds ran_on "
        "output_bytes error_bytes"
    )
    told: Options = dict.fromkeys(texts.split(), "") | dict.fromkeys(numbers.split(), 0)
    told |= {"seconds": [seconds], "user_seconds": seconds, "idle_seconds": seconds}
    told |= {"peak_memory_bytes": 1, "counted": {}, "out_of_time": False, "tree": "cgroup"}
    if os.environ.get("FAKE_IDLE") in one["command"]:
        told["user_seconds"] = 0
    try:
        done = subprocess.run(
            one["command"], cwd=one["folder"] or None, env={**os.environ, **one["environment"]},
            stdin=subprocess.DEVNULL, capture_output=True,
        )  # fmt: skip
    except OSError as error:
        return told | {"not_started": error.strerror}
    if one["output_file"]:
        Path(one["output_file"]).write_bytes(done.stdout)
    told |= {"exit_code": max(done.returncode, 0), "signal": max(-done.returncode, 0)}
    errors = done.stderr.decode().splitlines() or [""]
    return told | {"output_bytes": len(done.stdout), "error_end": errors[-1]}


def write(path: str, text: str) -> None:
    Path(path).write_text(text, encoding="utf-8")


def sha256(path: str) -> str:
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def template(name: str) -> dict[str, Any]:
    """What is the same in all records, by its part."""
    file = Path(os.environ["FAKE_RECORDS"])
    return dict(json.loads(file.read_text(encoding="utf-8"))[name])


def make_record(verb: str, scene: str, options: Options, wrong: bool) -> dict[str, Any]:
    seconds = 0.001 + float(os.environ.get("FAKE_SECONDS", "0"))
    runs = int(options.get("repetitions", 1)) if verb == "bench" else 1
    return any_record(
        verb,
        options,
        {
            "axes": axes(options),
            "scene": scene_of(scene),
            "warm_ups": int(options.get("warm-up", 0)),
            "repetitions": [] if wrong else [{"steps_seconds": seconds, "cpu_seconds": seconds}] * runs,
            "parse_seconds": 0.001,
            "process_seconds": runs * seconds + 0.01,
            "work": template("work") | {"steps": scene_of(scene)["steps"]},
            "errors": template("all_errors" if "errors" in options else "errors"),
            "check": {
                "verdict": "failed" if wrong else "passed",
                "scope": "last-step",
                "reason": "energy changed by 3 %" if wrong else None,
            },
            "state_hash": "0123456789abcdef",
        },
    )


def scene_of(path: str) -> dict[str, Any]:
    particles, side, radius, steps = map(float, Path(path).read_text(encoding="utf-8").split()[:4])
    return {
        "name": path,
        "sha256": sha256(path),
        "particles": int(particles),
        "side": side,
        "radius": radius,
        "steps": int(steps),
        "area_fraction": particles * 3.14159 * radius**2 / side**2,
    }


def any_record(kind: str, options: Options, measured: dict[str, Any]) -> dict[str, Any]:
    return {
        "schema_version": 2,
        "kind": kind,
        "recorded_at": os.environ.get("FAKE_NOW", "2024-01-01T00:00:00Z"),
        "contenders": [{"tags": options["tags"], **measured}],
        "turns": None,
        "provenance": provenance(),
    }


def make_limits(options: Options) -> dict[str, Any]:
    threads = {"threads": int(options["threads"])}
    limits = {kind: [one | threads for one in found] for kind, found in template("limits").items()}
    return any_record("limits", options, {"limits": limits})


def axes(options: Options) -> dict[str, Any]:
    said = {"variant": options["variant"], "tolerance": options.get("tolerance", "relative")}
    numbers = {"find-chunk": 4, "resolve-chunk": 5, "threads": 1, "substeps": 1}
    said |= {name.replace("-", "_"): int(options.get(name, number)) for name, number in numbers.items()}
    return template("policies") | said


def provenance() -> dict[str, Any]:
    def said(*beginnings: str) -> dict[str, str]:
        return {key: value for key, value in os.environ.items() if key.startswith(beginnings)}

    told = template("provenance")
    return told | {
        "host": os.uname().nodename,
        "openmp": told["openmp"] | {"environment": said("OMP_", "GOMP_", "KMP_")},
        "binary_sha256": sha256(__file__),
        "slurm": said("SLURM_", "SLURMD_") or None,
    }


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
