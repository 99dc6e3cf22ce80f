"""Makes what is published: every study of `scenarios/`, the programs of `publish.toml`, and the page over them.

What the same revision of the source has made is left as it is, so a publication that was stopped goes on when the
command is given again. The table at the end says of each what became of it, how many of its files are other than in git
and how many figures moved beyond their noise; `changes.txt` has them by name. Manifest, stamp and times are those of
the run that made the rest, and no change.
"""

import argparse
import csv
import fnmatch
import functools
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "results"
PUBLISHED = RESULTS / "published"
PLAN = RESULTS / "publish.toml"
MARK = "<!-- Made by `python3 results/publish.py --page`, which writes it anew. -->\n"
HEAD = "# Results\n"
STUDIES = """
## Studies

Each section is a study: its question, its result and, in most sections, the figure that shows the result. The mark …
means that the result is longer in the report. The name of the study leads to the report. The studies behind the answers
above come first, in the same order; the others follow by name.

The folder of a study also contains a manifest, and every number with its 95 % interval as CSV and LaTeX. It does not
contain the rows, which are the results of each method on each trial. The command in the section makes the rows again,
in `DIR/rows`, in the time that the section gives. A study of measured records needs the folder of these records in
`KEMPF_DATA`. The study `outside` also has answers of [estimators outside Kempf](../examples/external/README.md), which
the manifest does not contain.
"""


class Failed(Exception):
    """Why something cannot be done, for a person."""


def read(path):
    """A file of TOML that has to be right."""
    try:
        return tomllib.loads(path.read_bytes().decode())
    except (OSError, ValueError) as error:
        raise Failed(f"{path}: {error}") from None


def table(path):
    """A file of TOML; an empty one where it is missing or belongs to another version."""
    try:
        return read(path)
    except Failed:
        return {}


def read_plan():
    """`publish.toml`, and the files of the scenarios by their names."""
    plan = {"answers": {}, "question": [], "program": [], "check": []} | read(PLAN)
    for own in plan["program"]:
        if missing := {"name", "question", "page", "commands"} - own.keys():
            raise Failed(f"{PLAN}: program {own.get('name', '')}: give its {' and '.join(sorted(missing))}")
    folder = RESULTS / plan.get("scenarios", "?")
    files = [file for part in ("*.toml", "measured/*.toml") for file in folder.glob(part)]
    scenarios = {file.stem: Path(os.path.relpath(file, ROOT)) for file in files if "." not in file.stem}
    if not scenarios:
        raise Failed(f"{PLAN}: `scenarios` has to be the folder of the scenarios, as seen from {RESULTS}")
    return plan, dict(sorted(scenarios.items()))


def run(*words, stdout=subprocess.DEVNULL):
    """Runs a command in the root of the clone; returns what it wrote to standard output, where that is asked for."""
    words = [str(word) for word in words]
    try:
        child = subprocess.Popen(words, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=stdout)
        text, _ = child.communicate()
    except OSError as error:
        raise Failed(f"failed to start `{' '.join(words)}`: {error}") from None
    except KeyboardInterrupt:
        child.wait()  # It was asked to stop, too, and keeps what it has.
        raise
    if child.returncode != 0:
        raise Failed(f"`{' '.join(words)}` failed (exit code {child.returncode}); what it said stands above")
    return (text or b"").decode()


said = functools.partial(run, stdout=subprocess.PIPE)


class Program:
    """The release program `study`, built from what is committed."""

    def __init__(self):
        # Cargo says where it put the program.
        lines = said(*"cargo build --release --locked -p study --message-format json-render-diagnostics".split())
        made = [json.loads(line) for line in lines.splitlines() if line.startswith("{")]
        self.path = [one["executable"] for one in made if one.get("executable")][-1]
        version = said(self.path, "--version").strip()
        if not (found := re.fullmatch(r"study (\S+) \(revision (\w+)\)", version)):
            raise Failed(f"{self.path}: `{version}` names no revision of git; `cargo clean -p study -p kempf-campaign`")
        self.revision = {"version": found[1], "git-revision": said("git", "rev-parse", found[2]).strip()}

    def has_made(self, stored):
        """Whether a manifest or a stamp is of this program."""
        return not stored.get("git-dirty") and all(stored.get(key) == own for key, own in self.revision.items())


def make_study(name, scenario, program, answers, restart):
    """Runs a study, or what is missing of it, unless this program has done so; `answers` is the command of estimators
    that answer its trials, if any do."""
    place = PUBLISHED / name
    report = place / "report.md"
    if "records" in read(ROOT / scenario) and not os.environ.get("KEMPF_DATA"):
        return "skipped: it needs --data DIR, the measured records"
    [checked] = json.loads(said(program.path, "check", scenario, "--format", "json"))["scenarios"]

    def has_rows_of(stored):
        is_same = answers or stored.get("design-sha256") == checked["design_sha256"]
        return program.has_made(stored) and is_same

    stored, text = table(place / "manifest.toml"), (ROOT / scenario).read_bytes().decode()
    # A scenario that differs in its words alone is told again, with the rows that are there.
    is_told = stored.get("scenario", text) == text and report.is_file() and (place / "summary.csv").is_file()
    if has_rows_of(stored) and is_told and not restart:
        return "current"
    print(f"publishing {name}", file=sys.stderr, flush=True)
    report.unlink(missing_ok=True)  # It is written last: a study without it is not finished.
    again = ["--restart"] if restart or answers or (stored and not has_rows_of(stored)) else []
    if answers:
        trials = RESULTS / "scratch" / name
        shutil.rmtree(trials, ignore_errors=True)
        run(program.path, "simulate", scenario, "--replicate", "all", "--out", trials)
        (trials / "answers.csv").write_bytes(said(*answers, trials).encode())
        scenario = ["score", trials / "answers.csv", "--scenario", scenario]
    else:
        scenario = [scenario]
    run(program.path, *scenario, "--out", place.relative_to(ROOT), *again)
    shown = report.read_bytes().decode()
    for figure in [*place.glob("*.png"), *place.glob("*.svg")]:
        if f"{figure.stem}.png" not in shown:
            figure.unlink()
    return "made"


def make_program(own, program, data, restart):
    """Has a program of the plan fill a folder of its own, which takes the place of the old one when all went well."""
    place, scratch = PUBLISHED / own["name"], RESULTS / "scratch"
    stamp = table(place / "program.toml")
    if stamp.get("commands") == own["commands"] and program.has_made(stamp.get("program", {})) and not restart:
        return "current"
    if own.get("needs-records") and not data:
        return "skipped: it needs --data DIR, the measured records"
    print(f"publishing {own['name']}", file=sys.stderr, flush=True)
    shutil.rmtree(scratch, ignore_errors=True)
    made = scratch / own["name"]
    made.mkdir(parents=True)
    # As seen from where commands run, for it may be written into a page.
    places = {"{folder}": made.relative_to(ROOT).as_posix(), "{records}": str(data or "")}
    start = time.monotonic()
    for command in own["commands"]:
        words = [re.sub(r"\{folder\}|\{records\}", lambda found: places[found[0]], word) for word in command]
        run(*([program.path, *words[1:]] if words[0] == "study" else words))
    if "keep" in own:
        keep_only(made, own["keep"])
    stamp = f"commands = {json.dumps(own['commands'], ensure_ascii=False)}\n"
    stamp += f"wall-time-s = {round(time.monotonic() - start)}.0\n\n[program]\n"
    stamp += "".join(f'{key} = "{value}"\n' for key, value in program.revision.items())
    (made / "program.toml").write_bytes(stamp.encode())
    shutil.rmtree(place, ignore_errors=True)
    made.rename(place)
    shutil.rmtree(scratch)
    return "made"


def keep_only(folder, kept):
    """Removes all other files, and what pages say of figures among them: each a line with its caption below."""
    for file in [file for file in folder.rglob("*") if file.is_file()]:
        path = file.relative_to(folder).as_posix()
        if not any(fnmatch.fnmatch(path, pattern) for pattern in kept):
            file.unlink()
    for page in folder.rglob("*.md"):
        figure = re.compile(r"!\[[^]\n]*\]\(([^)\n]+)\)\n\n(?:\*[^\n]+\*\n\n)?")
        shown = lambda found: found[0] if (page.parent / found[1]).is_file() else ""  # noqa: E731
        number = itertools.count(2)
        text = figure.sub(shown, page.read_bytes().decode())
        # A figure has its number twice: in its image and in its caption.
        numbered = lambda found: f"{found[1]}{next(number) // 2}"  # noqa: E731
        page.write_bytes(re.sub(r"^(!\[Figure |\*Figure )\d+", numbered, text, flags=re.MULTILINE).encode())


def changes(name):
    """Published files of a folder that are other than in git, and the figures that moved."""
    options = ["--porcelain", "-z", "--no-renames", "--untracked-files=all"]
    lines = said("git", "status", *options, "--", f"results/published/{name}").split("\0")
    of_the_run = ("manifest.toml", "program.toml", "timings.csv", "")
    changed = [(line[:2], line[3:]) for line in lines if Path(line[3:]).name not in of_the_run]
    tables = [file for state, file in changed if file.endswith(".csv") and not {"?", "A", "D"} & set(state)]
    return [file for _, file in changed], [figure for file in tables for figure in moved_figures(file)]


def moved_figures(file):
    """Figures of a table whose 95 % interval no longer touches the one in git; none where lines or columns differ."""
    texts = said("git", "show", f"HEAD:{file}"), (ROOT / file).read_bytes().decode()
    old, new = (list(csv.reader(text.splitlines())) for text in texts)
    if not new or len(old) != len(new) or old[0] != new[0]:
        return []
    ends = [[bool(words & set(title.split())) for words in ({"lower", "low"}, {"upper", "high"})] for title in new[0]]
    columns = [k for k in range(len(ends) - 2) if not any(ends[k]) and ends[k + 1][0] and ends[k + 2][1]]
    moved = []
    for before, after, k in ((*lines, k) for lines in zip(old[1:], new[1:]) for k in columns):
        try:
            (was, low, high), (now, least, most) = (map(float, line[k : k + 3]) for line in (before, after))
        except ValueError:
            continue  # Not defined, then or now.
        # Where there is no noise, arithmetic alone moves the last digits.
        if abs(was - now) > 1e-3 * max(abs(was), abs(now)) and (high < least or most < low):
            labels = ", ".join(cell for cell in after[: columns[0]] if cell)
            told = " → ".join("{} [{}, {}]".format(*line[k : k + 3]) for line in (before, after))
            moved.append(f"{'/'.join(Path(file).parts[3:])}, {labels}: {new[0][k]}: {told}")
    return moved


def in_lines(text):
    """A text in lines as wide as those of every page."""
    return textwrap.fill(" ".join(text.split()), 120, break_long_words=False, break_on_hyphens=False)


def in_short(finding):
    """A finding up to the last end of a sentence, or semicolon, that two lines hold; with dots where more was found."""
    finding = in_lines(finding)
    ends = [found.end() for found in re.finditer(r"\.(?=\s+[A-Z0-9]|$)|;(?=\s)", finding)]
    parts = [in_lines(re.sub(";$", ".", finding[:end]) + (" …" if end < len(finding) else "")) for end in ends]
    return next((part for part in reversed(parts) if part.count("\n") < 2), finding)


def how_long(name):
    """The command that makes the rows of a study again, and the time that it took."""
    manifest = PUBLISHED / name / "manifest.toml"
    machine = table(manifest).get("machine", {})
    if not {"wall-time-s", "threads"} <= machine.keys():
        return ""
    seconds = machine["wall-time-s"]
    time = f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
    command = f"study {manifest.relative_to(ROOT).as_posix()} --out DIR"
    return in_lines(f"Rows in {time} on {machine['threads']} cores: `{command}`")


def write_page(plan, scenarios, place):
    """Writes the page over what is published: questions with their answers, what programs made, and the studies, in the
    words of their scenarios."""
    entries = [(own, own["page"], own.get("figure")) for own in plan["program"] if (PUBLISHED / own["name"]).is_dir()]
    for name, file in scenarios.items():
        if (PUBLISHED / name / "manifest.toml").is_file():
            words = read(ROOT / file)
            figure = words.get("output", {}).get("figure")
            stem = "hero" if figure and (PUBLISHED / name / "hero.png").is_file() else figure
            entries.append((words | {"name": name}, "report.md", stem and f"{stem}.png"))
    text, reports = HEAD, {words["name"]: f"published/{words['name']}/{report}" for words, report, _ in entries}
    for own in plan["question"]:
        if unknown := [name for name in own["studies"] if name not in reports]:
            raise Failed(f"{PLAN}: question {own['question']!r}: {', '.join(unknown)} is not published")
        links = ", ".join(f"[{name}]({reports[name]})" for name in own["studies"])
        text += f"\n**{own['question']}**\n\n" + in_lines(f"{own['answer']}({links})") + "\n"
    text += STUDIES
    order = [name for own in plan["question"] for name in own["studies"]]
    order += sorted(reports.keys() - set(order))
    for words, report, figure in sorted(entries, key=lambda entry: order.index(entry[0]["name"])):
        name, finding = words["name"], in_short(words.get("finding", ""))
        for file in filter(None, (report, figure)):
            if not (PUBLISHED / name / file).is_file():
                raise Failed(f"{PUBLISHED / name}: the page over all needs {file}, and the folder holds no such file")
        text += f"\n### [{name}](published/{name}/{report})\n\n**{words['question'].strip()}**\n"
        text += f"\n{finding}\n" if finding else ""
        rows = "" if name in plan["answers"] else how_long(name)
        text += f"\n{rows}\n" if rows else ""
        text += f"\n![Figure of {name}](published/{name}/{figure})\n" if figure else ""
    # HTML in the words is shown and not obeyed.
    tag = re.compile(r"\\.|<(?=[A-Za-z/!?])(?!http://|https://|mailto:)", re.DOTALL)
    text = tag.sub(lambda found: "\\<" if found[0] == "<" else found[0], text)
    Path(place).write_bytes((MARK + text).encode())
    return "made"


def publish(options, plan, scenarios):
    """Makes all that is asked for, the page and the checks; returns what became of each, files and figures."""
    known = [*scenarios, *(own["name"] for own in plan["program"])]
    if unknown := [name for name in options.only if name not in known]:
        raise Failed(f"--only: {', '.join(unknown)} is not published; there is {', '.join(known)}")
    data = options.data and Path(options.data).resolve()
    if data and not data.is_dir():
        raise Failed(f"--data {data}: there is no such folder; give that of the measured records")
    if changed := said("git", "status", "--porcelain", "--", ".", ":!results/published", ":!results/README.md"):
        raise Failed(f"this is not the source of a revision; commit or put away what was changed:\n{changed.rstrip()}")
    os.environ.update({"KEMPF_DATA": str(data)} if data else {})
    program, entries = Program(), []
    for name in sorted({place.name for place in PUBLISHED.iterdir()} - set(known)):
        print(f"warning: {PUBLISHED / name}: no scenario and no program makes it", file=sys.stderr)

    def attempt(name, make, *arguments):
        try:
            state = make(*arguments) or "passed"
        except (Failed, OSError, ValueError) as error:
            state = f"failed: {error}"
            print(f"{name}: {state}", file=sys.stderr, flush=True)
        entries.append((name, state, *(changes(name) if name in known else ([], []))))

    asked = options.only or known
    for name in [name for name in scenarios if name in asked]:
        attempt(name, make_study, name, scenarios[name], program, plan["answers"].get(name), options.restart)
    for own in [own for own in plan["program"] if own["name"] in asked]:
        attempt(own["name"], make_program, own, program, data, options.restart)
    attempt("results/README.md", write_page, plan, scenarios, RESULTS / "README.md")
    for check in plan["check"]:
        attempt(check["name"], run, *check["command"])
    return entries


def tell(entries):
    """Prints the table, and writes it to `changes.txt` with all that changed below it."""
    lines = [("", "files", "moved", "state")]
    lines += [(name, str(len(files)), str(len(moved)), state) for name, state, files, moved in entries]
    width = max(len(name) for name, *_ in lines)
    shown = "\n".join(f"{name:{width}}  {files:>5}  {moved:>5}  {state}" for name, files, moved, state in lines)
    print(f"{shown}\nby name: {RESULTS / 'changes.txt'}")
    for name, _, files, moved in entries:
        shown += "".join(f"\n{line}" for line in ("", f"{name}:", *files, *moved)) if files else ""
    (RESULTS / "changes.txt").write_bytes(f"{shown}\n".encode())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add = parser.add_argument
    add("--data", metavar="DIR", help="folder of the measured records; what needs them is skipped without it")
    add("--only", metavar="NAME,…", default=[], type=lambda names: names.split(","), help="what is made [default: all]")
    add("--restart", action="store_true", help="make anew also what this revision has made")
    add("--page", metavar="FILE", nargs="?", const=RESULTS / "README.md", help="write the page alone, or another file")
    options = parser.parse_args()
    try:
        plan, scenarios = read_plan()
        if options.page:
            return 0 if write_page(plan, scenarios, options.page) else 1
        entries = publish(options, plan, scenarios)
    except (Failed, OSError) as failure:
        print(f"error: {failure}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted; the same command goes on from there", file=sys.stderr)
        return 1
    tell(entries)
    return 0 if all(state in ("made", "current", "passed") for _, state, *_ in entries) else 1


if __name__ == "__main__":
    sys.exit(main())
