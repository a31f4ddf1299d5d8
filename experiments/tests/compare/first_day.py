"""What users do with `carom compare` on their first day, and what is right: the next case is one more row."""

from collections.abc import Mapping
from dataclasses import dataclass, field

LOOP = "i=0; while [ $i -lt {times} ]; do i=$((i+1)); done\n"


@dataclass(frozen=True)
class Case:
    """Files in an empty folder (scripts, but for those with a suffix), the words behind `carom compare`, and
    what then happens: `told` and not `untold` in what is printed, the exit code, the files that are there.
    """

    kind: str
    input: str
    right: str
    words: tuple[str, ...]
    told: tuple[str, ...] = ()
    untold: tuple[str, ...] = ()
    code: int | None = 0
    """None where it depends on the noise of the machine: 0, or 5 where the control differs by chance."""
    files: Mapping[str, str] = field(default_factory=dict)
    left: tuple[str, ...] = ()
    not_left: tuple[str, ...] = ()
    setup: str = ""
    """A line for a shell before it."""
    through: str = ""
    """A line for a shell that runs `"$@"`, the call."""
    time: str = "0.5s"

    @property
    def name(self) -> str:
        return f"{self.kind}: {self.input}"


TIMED, PRINTED, WRITTEN, LISTS, ENDS, TIME = (
    "what is timed", "printed times", "files", "lists", "ends", "time",
)  # fmt: skip

_TOOK = ("--time-from", r"took (\S+ ?[^\d\s]*)")
_BEHIND, _MS = ("--time-from", "took .*: ([0-9]+)"), ("--unit", "ms")
_NUMBER = ("--time-from", "took ([0-9.,e'+-]+)")

_TOOK_NUMBER = ("--time-from", "took ([0-9.]+)")

_TABLE = "echo 'Benchmark     Time     CPU   Iterations'\n"
_WORKS = {"short": LOOP.format(times=4000), "long": LOOP.format(times=12000)}
_FAST = "exit 0\n"


def _prints(first: str, second: str) -> dict[str, str]:
    return {"a": f"echo took '{first}'\n", "b": f"echo took '{second}'\n"}


def _refused(input_: str, printed: str, told: str, pattern: tuple[str, ...] = _NUMBER) -> Case:
    return Case(
        PRINTED, input_, "one line that says what stands there", (*pattern, "./a", "./b"), (told,),
        code=2, files=_prints(printed, printed),
    )  # fmt: skip


def _read(
    input_: str, first: str, second: str, change: str, *words: str, pattern: tuple[str, ...] = _NUMBER
) -> Case:
    return Case(
        PRINTED, input_, "both are read in their units", (*words, *pattern, "./a", "./b"),
        (f"b against a   {change} % [",), code=0, files=_prints(first, second), time="60s",
    )  # fmt: skip


CASES = (
    _read("µs beside ms", "500 µs", "1 ms", "+100.0"),
    _read("us beside µs", "500 us", "1000 µs", "+100.0"),
    _read("ns beside us", "1000 ns", "2 us", "+100.0"),
    _read("s beside min", "60 s", "2 min", "+100.0"),
    _read("an exponent", "1.5e-3 s", "3 ms", "+100.0"),
    _read("numbers in groups", "1,000.0 ms", "2 s", "+100.0"),
    _read("a decimal comma", "0,5 s", "1 s", "+100.0"),
    _read("no unit, and --unit", "1", "2", "+100.0", "--unit", "min"),
    _read("--unit, and a unit that stands there", "1 ms", "2 ms", "+100.0", "--unit", "s"),
    _refused("no unit", "1.1", "--unit"),
    _read("a point before the unit", "5. s", "10. s", "+100.0"),
    _refused("a number behind a time", "3 min 20", "as in 1 min 2.5 s", ("--time-from", "took (.*)")),
    _refused("a zero", "0 ms", "expected a positive number"),
    _refused("a negative number", "-3 ms", "expected a positive number"),
    _refused("no number", "nan ms", "time-from", _TOOK),
    _refused("an infinite number", "inf ms", "time-from", _TOOK),
    _refused("a comma that may be either", "1,234 ms", "1,234"),
    _refused("a part of a number", "1.5e3 ms", "1.5", ("--time-from", "took ([0-9.]+)")),
    _refused("a word behind the number", "5 parsecs", "at most a unit", ("--time-from", "took (.*)")),
    _refused("a count, and --unit", "5 fps", "with the unit 'fps'", (*_NUMBER, "--unit", "ms")),
    _refused("a letter that may be metres", "5m", "such as min where minutes are meant"),
    _read("a unit in brackets before the number", "[s]: 1", "(ms): 2000", "+100.0", *_MS, pattern=_BEHIND),
    _read("brackets that are no unit", "3 run(s): 1", "way [m]: 2", "+100.0", *_MS, pattern=_BEHIND),
    _refused("letters that are no unit", "5kms", "with the unit 'kms'", ("--time-from", "took ([0-9]+)")),
    _refused("seconds and milliseconds", "2 s 300 ms", "a longer number", ("--time-from", "took ([0-9.]+)")),
    _refused("a unit in capitals, and --unit", "12 MS", "with the unit 'MS'", (*_NUMBER, "--unit", "us")),
    _read("a narrow blank before the unit, and --unit", "1\u202fms", "2\u00a0ms", "+100.0", "--unit", "s"),
    _refused("two matches in one line", "1 ms took 2 ms", "2"),
    Case(
        TIMED, "a script that prints the table of a Google Benchmark",
        "refused: it repeats its cases until their time is full; --no-gb times it all the same",
        ("./a", "./b"), ("a: runs a Google Benchmark", "--no-gb"), code=1,
        files={"a": _TABLE, "b": _TABLE},
    ),
    Case(
        TIMED, "a Google Benchmark behind a tool that hides what it prints", "refused as well",
        ("make -s", "true"), ("/bench: is a Google Benchmark, which repeats its cases", "--no-gb"), code=1,
        files={"Makefile": "all:\n\t$$PWD/bench --benchmark_min_time=0.01 >/dev/null 2>&1\n"},
        setup="printf '#include <benchmark/benchmark.h>\n"
        "static void f(benchmark::State& s) { for (auto _ : s) {} }\nBENCHMARK(f);BENCHMARK_MAIN();' "
        "| g++ -xc++ - -lbenchmark -lpthread -o bench",
    ),
    Case(
        TIMED, "the same with --no-gb", "timed as a whole", ("--no-gb", "./a", "./b"), ("  a  ", "  b  "),
        ("runs a Google Benchmark",), code=None, files={"a": _TABLE, "b": _TABLE},
    ),
    Case(
        TIMED, "a first run that takes far longer", "a line that says so and names --prepare",
        ("-n", "a", "-n", "b", "./a", "./b"),
        ("the first run of a took", "--prepare"), code=None,
        files={
            "a": f"[ -e built_a ] || {{ sleep 0.5; touch built_a; }}; {LOOP.format(times=4000)}",
            "b": LOOP.format(times=4000),
        }, time="2s",
    ),
    Case(
        TIMED, "a first run that takes far longer, in the only block",
        "the same line, by the second run of the reference",
        ("-n", "a", "-n", "b", "./a", "./a"),
        ("1 block", "the first run of a took", "--prepare", "each command ran once"), code=None,
        files={"a": f"[ -e built_a ] || {{ sleep 0.9; touch built_a; }}; {LOOP.format(times=40000)}"},
    ),
    Case(
        TIME, "six blocks of a command with --prepare, foretold from one", "the preparation counts",
        ("--prepare", "sleep 0.6", "sleep 0.1", "true"), ("1 block", "`--time 1"), ("`--time 1s`",),
        code=None,
    ),
    Case(
        PRINTED, "the same time of a single digit", "no verdict: one line that says how little it tells",
        (*_TOOK, "./a", "./b"), ("a: prints 100 ms in all of", "known to 50 %; expected more digits"), code=1,
        files={"a": "sleep 0.06; echo took 0.1 s\n", "b": "sleep 0.09; echo took 0.1 s\n"}, time="4s",
    ),
    Case(
        PRINTED, "the same digit of two programs that differ by more", "their difference",
        (*_TOOK, "./a", "./b"), ("+100.0",), code=None,
        files=_prints("0.1 s", "0.2 s"), time="10s",
    ),
    Case(
        PRINTED, "an amount of something else, with --unit", "one line that says what stands there",
        (*_NUMBER, "--unit", "s", "./a", "./b"), ("found '12' with the unit 'MB/s', expected a time",),
        code=2, files={"a": "echo took 12 MB/s\n", "b": "echo took 13 MB/s\n"},
    ),
    Case(
        PRINTED, "thousands behind a blank", "one line that says what stands there",
        ("--time-from", "took ([0-9]+)", "--unit", "s", "./a", "./b"),
        ("found '1' within a longer number in 'took 1 234 ms'",), code=2,
        files=_prints("1 234 ms", "1 234 ms"),
    ),
    _read("a unit behind a spread, and --unit", "500\u00b120 ms", "1 s", "+100.0", "--unit", "h"),
    _read("--unit with a Greek letter", "1", "2", "+100.0", "--unit", "\u00b5s"),
    Case(
        LISTS, "a name with a placeholder that nobody fills in", "refused",
        ("-n", "x {g}", "-n", "y", "true", "ls"), ("-n: found {g}, expected a list or range of that name",),
        code=1,
    ),
    _refused("a rate", "12.5 ns/day", "found '12.5' with '/day' behind its unit", _TOOK_NUMBER),
    _refused("a time that goes on in a smaller unit", "12 ms 345 us", "within a longer number", _TOOK_NUMBER),
    Case(
        LISTS, "a placeholder in a value of a list", "refused: nothing is filled in there",
        ("-P", "t", "1", "2", "-L", "m", "-j{t},-s", "echo {m} {t}"),
        ('found "-j{t}" as a value of m, in which {t} is not filled in',), code=1,
    ),
    Case(
        LISTS, "a placeholder in --input that has no values", "the option that would give them",
        ("-L", "n", "1,2", "--input", "in{zz}", "echo {n}"), ("-L zz A,B",), code=1,
    ),
    Case(
        LISTS, "a list without its values", "the command that was taken for them is named",
        ("-L", "x", "sleep 0.{x}", "true"), ('found "sleep 0.{x}" as a value of x',), code=1,
    ),
    Case(
        LISTS, "a name of a list that begins with a digit", "what a name begins with",
        ("-P", "1n", "1", "2", "echo {1n}"),
        ("-P: found \"1n\", expected a name that begins with a letter", "-P NAME FIRST LAST [STEP]"), code=1,
    ),
    Case(
        TIMED, "a line for a shell, with --gb", "refused: it hands no arguments on",
        ("--gb", "./a > x", "./b > x"), ("./a > x: is a line for a shell, which hands no arguments on",),
        code=1, files={"a": _TABLE, "b": _TABLE},
    ),
    Case(
        TIMED, "an option twice that is there once for all commands", "refused: one would be dropped",
        ("--input", "a", "--input", "b", "./a", "./b"), ("found --input twice, expected it once",), code=1,
        files={"a": _FAST, "b": _FAST},
    ),
    Case(
        TIMED, "a program that prints words of our own", "they stay as they are",
        ("./a", "true"), ("exit code 1: prepare: no table",), ("--prepare",), code=2,
        files={"a": "echo prepare: no table >&2; exit 1"},
    ),
    Case(
        ENDS, "a full disk behind standard error", "the result, and the export",
        ("--warmup", "1", "--export-csv", "rows.csv", "true", "ls"), ("  true  ",), code=None,
        through='"$@" 2>/dev/full', left=("rows.csv",),
    ),
    Case(
        TIME, "no room for six blocks", "no time goes to finding out who may be stopped",
        ("sleep 0.3", "sleep 0.31"), ("  sleep 0.3  ",), ("never stopped",), code=None, time="2s",
    ),
    Case(
        TIME, "a terminal that tells no width", "its line is drawn for 80 columns",
        ("true", "ls"), ("making ready",), code=None,
        through='script -qec "$*" /dev/null </dev/null',
    ),
    Case(
        TIME, "what comes before and after, on a terminal", "a line each second",
        ("--setup", "sleep 1.2", "--cleanup", "sleep 1.2", "true", "ls"),
        ("--setup: sleep 1.2, 1 s", "--cleanup: sleep 1.2, 1 s"), code=None,
        through='script -qec "$1 $2 $3 $4 $5 \'$6\' $7 \'$8\' $9 ${10}" /dev/null </dev/null',
    ),
    Case(
        TIME, "runs that come before each timed one", "how many the first block has is said before it",
        ("--warmup", "2", "true", "ls"), ("--warmup: the first block is 9 runs, however long they take",),
        code=None,
    ),
    Case(
        TIMED, "something in standard input", "a line names --input", ("cat", "true"),
        ("standard input has something", "--input FILE"), code=None, through='seq 9 | "$@"',
    ),
    Case(
        TIMED, "nothing in standard input", "no line on it", ("cat", "true"), (), ("standard input",),
        code=None, through='"$@" </dev/null | cat && true | "$@"',
    ),
    Case(
        TIMED, "a tool whose exit code is an answer", "the option that lets it count",
        ("grep -q a /dev/null", "true"), ("`--ignore-exit 1` lets it count",), code=2,
    ),
    Case(
        TIME, "a time below zero", "it is named", ("--time", "-1s", "true", "ls"), ("found -1s",), code=1,
    ),
    Case(
        ENDS, "standard output is closed, and no export is asked for", "said before anything is run",
        ("touch ran", "true"), ("standard output: is closed",), code=1, not_left=("ran",), through='"$@" >&-',
    ),
    Case(
        ENDS, "a help that finds no room", "one line", ("--help",), ("standard output: No space left",),
        ("Exception",), code=1, through='"$1" "$2" --help >/dev/full',
    ),
    Case(
        ENDS, "a first command of a pipe that fails", "what it says is told",
        ("ls /none | true", "true"), ("cannot access", "of commands in a pipe the last alone"), code=None,
    ),
    Case(
        ENDS, "a signal while --cleanup runs", "a line that says that it was stopped",
        ("--cleanup", "touch began; sleep 20; touch ended", "true", "ls"),
        ("carom: --cleanup: touch began; sleep 20; touch ended: was stopped before its end", "  true  "),
        code=143, left=("began",), not_left=("ended",), time="1ms",
        through='"$@" & while ! [ -e began ]; do sleep 0.1; done; kill -TERM $!; wait $!',
    ),
    Case(
        WRITTEN, "an export into a folder that is not there", "refused before anything is measured",
        ("--export-csv", "nowhere/x", "true", "ls"),
        ("--export-csv: found nowhere/x, expected a file in a folder that is there",), code=1,
        not_left=("nowhere",),
    ),
    Case(
        WRITTEN, "an export to nothing, as an empty variable is", "refused",
        ("--export-csv", "", "true", "ls"), ("--export-csv: found nothing, which is no name",), code=1,
    ),
    Case(
        WRITTEN, "an export that ends with a slash", "refused", ("--export-csv", "nowhere/", "true", "ls"),
        ("--export-csv: found nowhere/, which is no name of a file",), code=1, not_left=("nowhere",),
    ),
    Case(
        WRITTEN, "two exports to two names of one file", "refused",
        ("--export-csv", "one", "--export-json", "other", "true", "ls"), ("expected another file",), code=1,
        setup="touch one; ln one other",
    ),
    Case(
        LISTS, "--append with a placeholder", "refused: it is one file for all commands",
        ("-L", "x", "1,2", "--append", "a-{x}", "sleep 0.0{x}"),
        ("--append: found a-{x}, expected one file for all commands",), code=1, not_left=("a-{x}",),
    ),
    Case(
        LISTS, "a placeholder in a variable that nobody fills in", "refused",
        ("-L", "x", "1,2", "--env", "A={y}", "sleep 0.0{x}"),
        ("--env: found {y}, expected a list or range of that name",), code=1,
    ),
    Case(
        TIMED, "runs of one command with unlike exit codes", "not compared; how many ended with which",
        ("--ignore-exit", "4", "./a", "./b"), ("a: failed", "with exit code 0", "with exit code 4"),
        code=2, time="10s",
        files={"a": 'echo x >> n; [ $(($(wc -l < n) % 2)) = 0 ] || exit 4; sleep 0.1', "b": "sleep 0.1"},
    ),
    Case(
        TIMED, "two commands that end with unlike codes", "a line that says so",
        ("--ignore-exit", "1", "./a", "./b"), ("not all end alike: a:", "with exit code 1"), code=None,
        files={"a": LOOP.format(times=9000), "b": LOOP.format(times=9000) + "exit 1"},
    ),
    Case(
        TIMED, "work left in the background", "waited for in each run",
        ("./a", "./b"), ("a   ", "10"), code=None, files={"a": "sleep 0.1 &\nexit 0", "b": "sleep 0.1"},
        through='"$@" > out; cat out; grep -Eq "^  a +1[0-9][0-9] ms" out',
    ),
    Case(
        TIMED, "work left in the background for far longer than the command", "a line that says so",
        ("./a", "./b"), ("% of the time of a is of what it has left in the background",), code=None,
        files={"a": "sleep 0.2 &\nexit 0", "b": "sleep 0.1"},
    ),
    Case(
        TIMED, "a line whose first program is not there", "what the shell says",
        ("nosuchprogram; true", "true"),
        ("writes to standard error: ", "nosuchprogram: not found", "a shell starts lines"), code=None,
    ),
    Case(
        TIMED, "a command that works once", "the advice to put things back", ("mkdir x", "true"),
        ("mkdir x: failed after ", "File exists", "--prepare"), code=2,
    ),
    Case(
        TIMED, "a setup that starts a server", "it goes on until the end, and not longer",
        ("--setup", "sleep 97 & echo $! > pid", "sh -c 'kill -0 $(cat pid)'", "true"),
        ("  true  ",), code=None,
        through='"$@"; code=$?; kill -0 $(cat pid) 2>/dev/null || exit $code; exit 9',
    ),
    Case(
        TIMED, "commands that fail, and differ in one word", "each is named as it was written",
        ("ls -l x", "ls -a x"),
        ("carom: ls -l x: failed after 0 runs: exit code 2", "carom: ls -a x: failed after 0 runs"), code=2,
    ),
    Case(
        TIMED, "options between commands", "options",
        ("true", "-n", "a", "ls", "-n", "b"), ("  a  ", "  b  "), code=None,
    ),
    Case(
        TIMED, "options of another tool", "the first of them is named", ("-w", "3", "-r", "10", "true", "ls"),
        ("unrecognized arguments: -w (",), code=1,
    ),
    Case(
        TIMED, "--vs between lines", "one line that says what is missing", ("true", "--vs", "ls"),
        ("found --vs, expected `--` before it",), code=1,
    ),
    Case(
        TIMED, "a script without a first line for its interpreter", "the line is named",
        ("sh -c :", "./a.sh"), ("./a.sh: failed after 0 runs: ", "in its first line, as #!/bin/sh"), code=2,
        files={"a.sh": "true"}, setup="chmod +x a.sh",
    ),
    Case(
        TIMED, "Carom itself", "is no Google Benchmark, although it loads the library",
        ("-n", "true", "-n", "carom", "true"), ("  carom  ",), ("Google Benchmark",), code=None,
        through='"$@" "$1 --version"',
    ),
    Case(
        TIMED, "a command that fails now and then", "how many runs ended well, how this one ended, no cause",
        ("--turns", "off", "./a", "./b"), (" runs that ended well: exit code 3: bad luck", "  b   "),
        ("now and then",), code=2,
        files={
            "a": LOOP.format(times=20000)
            + "echo x >> n; [ $(wc -l < n) != 9 ] || { echo bad luck >&2; exit 3; }",
            "b": LOOP.format(times=40000),
        }, time="10s",
    ),
    Case(
        TIMED, "work that --prepare leaves in the background", "noticed soon, and named",
        ("--prepare", "sleep 98 &", "-n", "true", "-n", "ls", "true", "ls"),
        ("true: failed after 0 runs: --prepare: left sleep running in the background", "`--setup`"),
        code=2, through='timeout 40 "$@"',
    ),
    Case(
        TIMED, "a program that needs a terminal", "the hint that it has none", ("./a", "./b"),
        ("a: failed after 0 runs: exit code 1 without a word", "terminal"), code=2,
        files={"a": "test -t 1", "b": _FAST},
    ),
    Case(
        TIMED, "a program killed by a signal", "the signal, once", ("./a", "./b"), ("killed by SIGABRT",),
        ("SIGABRT: killed",), code=2, files={"a": "kill -ABRT $$", "b": _FAST},
    ),
    Case(
        TIMED, "turns although nobody knows whether they wait for one another", "that nobody looks",
        ("--turns", "10ms", "-n", "a", "-n", "b", "./a", "./a"),
        ("carom: --turns: nobody looks whether a command waits for one that is stopped; --turns auto does",),
        files={"a": LOOP.format(times=20000)},
    ),
    Case(
        TIMED, "programs that wait for one lock by spinning", "none of them is stopped, and why",
        ("./a", "./b"), ("never stopped",), code=None, time="8s",
        files={
            "a": "until mkdir lock 2>/dev/null; do :; done; " + LOOP.format(times=60000) + "rmdir lock",
            "b": "until mkdir lock 2>/dev/null; do :; done; " + LOOP.format(times=90000) + "rmdir lock",
        },
    ),
    Case(
        TIMED, "a comparison within a comparison", "one line at once: each would wait for the other",
        ("-n", "true", "-n", "inner", "true"), ("inner: failed after 0 runs", "runs within another measure"),
        code=2, through='"$@" "$1 compare true ls"',
    ),
    Case(
        TIME, "a short command beside a long one", "each as often as it needs, within --time",
        ("true", "./b"), ("true 15", "b 1"), code=None, files={"b": "sleep 0.3"}, time="2s",
    ),
    Case(
        TIME, "a slow preparation of short commands", "fewer runs, within --time",
        ("--prepare", "sleep 0.2", "true", "./b"), ("true 1, b 1",), code=None, files={"b": _FAST}, time="1s",
    ),
    Case(
        TIME, "no time for an interval", "one run of each, and what would be needed",
        ("./short", "./long"), ("1 block: an interval needs 6 blocks",), files=_WORKS, time="1ms",
    ),
    Case(
        LISTS, "a list in --prepare and in the command", "filled in in both",
        ("-L", "v", "one,two", "--prepare", "touch p_{v}", "ls p_{v}"), ("  p_one  ", "  p_two  "), ("{v}",),
        code=None, left=("p_one", "p_two"), not_left=("p_{v}",),
    ),
    Case(
        LISTS, "a list that only --prepare has", "a command for each value",
        ("-L", "v", "x,y", "--prepare", "touch {v}", "true"), ("  true (v y)  ", "  true (v x)  "), code=None,
        left=("x", "y"),
    ),
    Case(
        LISTS, "a list in --setup and --cleanup", "both run once for each value",
        ("-L", "v", "x,y", "--setup", "touch {v}", "--cleanup", "touch {v}_gone", "ls {v}"),
        ("  x  ", "  y  "), code=None, left=("x_gone", "y_gone"),
    ),
    Case(
        LISTS, "a name with a placeholder", "filled in", ("-L", "v", "1,2", "-n", "run {v}", "echo {v}"),
        ("  run 1  ", "  run 2  "), code=None,
    ),
    Case(
        LISTS, "values that begin with a dash", "values", ("-L", "f", "--sort=none,-l", "ls {f}"),
        ("  -l  ", "  --sort=none  "), code=None,
    ),
    Case(
        LISTS, "braces of awk and of the shell", "left alone",
        ("-L", "v", "a,b", "awk '{print $1}' {v}", "--prepare", "touch ${TMPDIR}/{v}"),
        ("  a  ", "  b  "), code=None, files={"a.txt": "", "b.txt": ""}, setup="touch a b",
    ),
    Case(
        LISTS, "a placeholder without a list", "one line names it", ("--prepare", "touch {t}", "true", "ls"),
        ("--prepare: found {t}, expected a list",), code=1, not_left=("{t}",),
    ),
    Case(
        LISTS, "steps and decimals", "ranges", ("-P", "i", "0.1", "0.5", "0.2", "echo {i}"),
        ("  echo 0.1  ", "  echo 0.3  ", "  echo 0.5  "), code=None,
    ),
    Case(
        LISTS, "blanks between values", "one line that says how they are written",
        ("-L", "n", "1000", "2000", "seq {n}"),
        ("-L n: found 2000 behind 1000, ", "expected commas between values: -L n 1000,2000"), code=1,
    ),
    Case(
        LISTS, "`=` between a name and its values", "one line that says how they are written",
        ("-L", "n=1,2", "seq {n}"), ("and then its values: -L NAME A,B",), code=1,
    ),
    Case(
        LISTS, "a thousand values", "the option that makes them is named",
        ("-P", "i", "1", "1000", "echo {i}"), ("-P i: found 1 1000, which makes 1000 commands",), code=1,
    ),
    Case(
        LISTS, "one of several that fails", "the others go on, it is listed",
        ("-L", "t", "0.1,0.12,oops,0.15", "sleep {t}"),
        ("sleep oops: failed after 0 runs", "  sleep 0.12  ", "  sleep 0.15  "), code=2, time="2s",
    ),
    Case(
        WRITTEN, "two exports that cannot be written", "each is named, and the third is there",
        ("--export-json", "full", "--export-csv", "kept/b", "--export-markdown", "c", "./gone", "true"),
        ("full: No space left on device", "kept: File exists"), code=1, left=("c",),
        files={"gone": "rm -rf kept; : > kept\n"}, setup="ln -s /dev/full full; mkdir kept",
    ),
    Case(
        WRITTEN, "an export to a device", "written to it; what it refuses is told, and it stays a device",
        ("--export-json", "full", "true", "ls"), ("full: No space left on device",), code=1,
        setup="ln -s /dev/full full",
        through='"$@"; code=$?; test -c /dev/full && test -h full && exit $code',
    ),
    Case(
        WRITTEN, "an export to a pipe", "its reader gets it", ("--export-csv", "pipe", "true", "ls"),
        ("command,case,block",), code=None, setup="mkfifo pipe",
        through='cat pipe > got & "$@"; code=$?; wait; cat got; test -p pipe && exit $code',
    ),
    Case(
        WRITTEN, "an export to a link", "its target is replaced", ("--export-csv", "link", "true", "ls"),
        code=None, setup="echo old > file; ln -s file link",
        through='"$@"; code=$?; test -h link && grep -q command file && exit $code',
    ),
    Case(
        WRITTEN, "an export to -", "standard output has it, and the result stands beside",
        ("--export-json", "-", "true", "ls"), ('"schema_version"', "  true  "), code=None,
        through='"$@" > out; code=$?; grep -q schema_version out && ! grep -q against out && cat out;'
        "exit $code",
    ),
    Case(
        WRITTEN, "an export to /dev/stdout", "the same", ("--export-csv", "/dev/stdout", "true", "ls"),
        ("command,case,block",), code=None,
    ),
    Case(
        WRITTEN, "two exports to one name", "refused",
        ("--export-json", "x", "--export-csv", "./x", "true", "ls"),
        ("--export-csv: found x, which --export-json names too",), code=1, not_left=("x",),
    ),
    Case(
        WRITTEN, "one export given twice", "refused",
        ("--export-csv", "x", "--export-csv", "y", "true", "ls"),
        ("--export-csv: found x and y, expected one file",), code=1, not_left=("x", "y"),
    ),
    Case(
        WRITTEN, "an export to a program that is compared", "refused",
        ("--export-json", "./a", "./a", "true"),
        ("--export-json: found ./a, which ./a uses",), code=1, files={"a": "exit 0"},
    ),
    Case(
        WRITTEN, "an export to a link to itself", "refused", ("--export-json", "loop", "true", "ls"),
        ("--export-json: found loop, which is a link to itself",), code=1, setup="ln -s loop loop",
    ),
    Case(
        WRITTEN, "an export over a file of some mode", "the mode stays", ("--export-csv", "x", "true", "ls"),
        code=None, setup="echo > x; chmod 640 x",
        through='"$@"; code=$?; test $(stat -c %a x) = 640 && exit $code',
    ),
    Case(
        WRITTEN, "an export and --append to one name", "refused",
        ("--export-json", "x", "--append", "x", "true", "ls"), ("which --export-json names too",), code=1,
        not_left=("x",),
    ),
    Case(
        WRITTEN, "--append to a device", "refused", ("--append", "/dev/null", "true", "ls"),
        ("--append: found /dev/null, which is no file",), code=1,
    ),
    Case(
        ENDS, "Python parts that the user may not read", "one line that names them", ("true", "ls"),
        ("compare: needs Carom's Python parts, of which you may not read ", "/.venv/bin/python"), code=1,
        through="all=$(mktemp -d -p /tmp) && chmod 755 $all && mkdir -p $all/build/gcc $all/.venv/bin\n"
        'cp "$1" $all/build/gcc/ && touch $all/.venv/bin/python && chmod 0 $all/.venv/bin; shift\n'
        "[ $(id -u) != 0 ] || other='setpriv --reuid=65534 --clear-groups'\n"
        'cd /; $other $all/build/gcc/carom "$@"; code=$?; chmod 755 $all/.venv/bin; rm -r $all; exit $code',
    ),
    Case(
        ENDS, "a working folder that is gone", "one line that says so", ("true", "ls"),
        ("carom: is called in a folder that is gone",), code=1, through='mkdir x; cd x; rmdir ../x; "$@"',
    ),
    Case(
        ENDS, "Ctrl-C at once", "ends silently", ("true", "ls"), untold=("Traceback",), code=130,
        through='timeout --preserve-status --signal=INT 0.1 "$@"',
    ),
    Case(
        ENDS, "a signal that Slurm sends ahead of its limit", "the result is told and written",
        ("--export-csv", "x", "--margin", "0.01%", "-n", "a", "-n", "b", "./short", "./short"),
        ("  a   ", "  b   "), code=140, left=("x",), files=_WORKS,
        through='"$@" & until ls tmp/*/records/*/*/*-b1.json; do sleep 0.1; done >/dev/null 2>&1\n'
        "kill -USR2 $!; wait $!", time="60s",
    ),
    Case(
        ENDS, "standard output is closed", "said, and what was asked for is written",
        ("--export-csv", "x", "true", "ls"), ("standard output: is closed",), code=1, left=("x",),
        through='"$@" >&-',
    ),
    Case(
        ENDS, "standard error is closed", "the result all the same", ("true", "ls"), ("  true  ", "  ls  "),
        code=None, through='"$@" 2>&-',
    ),
    Case(
        ENDS, "standard output has no room", "said, and what was asked for is written",
        ("--export-csv", "x", "true", "ls"), ("standard output: No space left",), ("half-written",), code=1,
        left=("x",),
        through='"$@" >/dev/full',
    ),
    Case(
        ENDS, "a reader that goes", "what was asked for is written", ("--export-csv", "x", "true", "ls"),
        left=("x",), through='"$@" | head -n 1 > first', code=0,
    ),
    Case(
        ENDS, "a reader that is gone before the result", "said, and what was asked for is written",
        ("--export-csv", "x", "true", "ls"), ("standard output: its reader is gone",), code=1, left=("x",),
        through='mkfifo gone; (exec < gone) & "$@" > gone',
    ),
)  # fmt: skip
