# SPDX-License-Identifier: MIT
"""Makes the files of a release: tools/release --help."""

import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.progress import Progress  # noqa: E402
from tools.releasing.options import arguments  # noqa: E402
from tools.releasing.parts import PARTS, Missing, finish  # noqa: E402
from tools.releasing.version import changes, version  # noqa: E402


def say(line):
    print(line, file=sys.stderr, flush=True)


def disagreement(tag):
    """Why no release can be made of this tree; None if it can."""
    number = version(TOP)
    if changes(TOP)[0] != number:
        return f"the changes begin with {changes(TOP)[0]}, and the version is {number}"
    if tag and tag != f"v{number}":
        return f"the tag is {tag}, and the version {number}: v{number}"
    return None


def make(parts, folder):
    """How many parts could not be made. What an earlier run has left there is replaced."""
    progress, missing = Progress(len(parts)), 0
    for number, part in enumerate(parts):
        say(f"{part.name}: {part.what}, {progress.line(number)}")
        with tempfile.TemporaryDirectory(dir=folder) as made:
            try:
                part.make(TOP, Path(made))
            except Missing as reason:
                say(f"    not made: {reason}")
                missing += 1
            for path in Path(made).iterdir():
                path.replace(folder / path.name)
    finish(TOP, folder)
    return missing


def main():
    chosen = arguments(sys.argv[1:])
    wrong = disagreement(chosen.tag)
    if wrong:
        say(f"tools/release: {wrong}")
        return 1
    parts = [part for part in PARTS if not chosen.only or part.name in chosen.only]
    folder = Path(chosen.output)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        missing = make(parts, folder.resolve())
    except OSError as error:
        say(f"tools/release: {error.filename}: {error.strerror}")
        return 1
    for path in sorted(folder.iterdir()):
        print(f"{path}  {path.stat().st_size} bytes")
    return 1 if missing else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
