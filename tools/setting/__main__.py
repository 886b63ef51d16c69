# SPDX-License-Identifier: MIT
"""Shows and changes the settings and parameter sets of a panel: tools/settings --help."""

import json
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)
sys.path[1:1] = map(str, (TOP / "tools" / "pc", TOP / "firmware"))

import uss_serial  # noqa: E402, F401 - brings the module `micropython`

from tools.deploying.errors import DeployError  # noqa: E402
from tools.setting.options import arguments  # noqa: E402
from tools.setting.places import BAD, ENDING, SETTINGS, Folder, OnChip  # noqa: E402
from tools.setting.schema import (  # noqa: E402
    Mistake,
    as_dictionary,
    changed,
    check,
    check_names,
    check_set,
    loaded,
    table,
    whole,
)

FAILED, WRONG = 1, 2
USUAL_EDITOR = "vi"


def say(line):
    print(line, file=sys.stderr, flush=True)


def place_of(chosen):
    if chosen.file:
        return Folder(chosen.file)
    port = chosen.port
    if port is None:
        from serial.tools.list_ports import comports

        from tools.deploying.ports import choose_any, waits_for_uf2

        port = choose_any(comports(), waits_for_uf2())
    return OnChip(port, say)


# ---- the commands -----------------------------------------------------------------------------


def get(chosen):
    check_names(chosen.names)
    with place_of(chosen) as place:
        data = place.read(place.settings)
        sets = place.sets()
    settings = loaded(data)
    if chosen.json:
        of = as_dictionary(settings)
        print(json.dumps({name: of[name] for name in chosen.names or of}))
    else:
        for line in table(settings, chosen.names):
            print(line)
    if data is None:
        say("There is no file of settings yet: these are the defaults.")
    if sets and not chosen.names:
        say(f"Sets: {' '.join(sets)}")
    if settings.complaint:
        raise Mistake(f"the panel says SETTINGS DAMAGED: {settings.complaint}")


def put(place, before, new):
    """Write settings that differ; what the panel could not read stays beside them."""
    if new == before:
        say("It is so already: nothing is written.")
        return
    if before is not None and loaded(before).complaint:
        place.write(place.settings + BAD, before)
    place.write(place.settings, new)
    say(f"{place.settings} is written.")


def change(chosen):
    changed(None, chosen.changes)  # what is wrong in any case is told before a drive is stopped
    with place_of(chosen) as place:
        before = place.read(place.settings)
        put(place, before, changed(before, chosen.changes))


def edit(chosen):
    place = place_of(chosen)
    with place:
        before = place.read(place.settings)
    shown = before
    if before is None or not loaded(before).complaint:
        shown = whole(before)
    new = edited(shown)
    if new == shown:
        say("Nothing was changed.")
        return
    with place:
        if place.read(place.settings) != before:
            raise Mistake(f"they have changed meanwhile: what you typed is in {kept(new)}")
        put(place, before, new)


def edited(shown):
    """What a person makes of these settings, without a mistake."""
    editor = os.environ.get("VISUAL") or os.environ.get("EDITOR") or USUAL_EDITOR
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, SETTINGS)
        path.write_bytes(shown)
        while True:
            try:
                status = subprocess.call([*shlex.split(editor), str(path)])
            except OSError as error:
                raise Mistake(f"{editor}: {error.strerror}: say another one in EDITOR") from None
            if status:
                raise Mistake(f"{editor} ended with status {status}: nothing is written")
            new = path.read_bytes()
            try:
                check(new)
                return new
            except Mistake as mistake:
                say(f"tools/settings: {mistake}")
                if not agreed("Edit once more? yes/no: "):
                    where = kept(new)
                    raise Mistake(f"nothing is written: what you typed is in {where}") from None


def kept(data):
    number, path = tempfile.mkstemp(prefix="settings.", suffix=".json")
    with os.fdopen(number, "wb") as file:
        file.write(data)
    return path


def agreed(question):
    try:
        return sys.stdin.isatty() and input(question).strip() == "yes"
    except EOFError:
        return False


def out(chosen):
    folder = Path(chosen.folder)
    with place_of(chosen) as place:
        settings = place.read(place.settings)
        files = {} if settings is None else {SETTINGS: settings}
        files |= {name: place.read(name) for name in place.sets()}
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        path = folder / name
        if path.exists() and path.read_bytes() != data:
            raise Mistake(f"{path} is there already, and differs: nothing of it is replaced")
    for name, data in files.items():
        Folder(folder / name).write(name, data)
        say(f"{folder / name}  {len(data)} bytes")
    if not files:
        say("There are neither settings nor sets.")


def bring(chosen):
    files = {}
    for path in map(Path, chosen.files):
        data, is_set = path.read_bytes(), path.name.endswith(ENDING)
        name = path.name if is_set else None
        if name in files:
            raise Mistake(f"{path}: one file of settings, and each set once")
        try:
            check_set(path.name, data) if is_set else check(data)
        except Mistake as mistake:
            raise Mistake(f"{path}: {mistake}") from None
        files[name] = data
    with place_of(chosen) as place:
        for name, data in files.items():
            if name is None:
                put(place, place.read(place.settings), data)
            elif place.read(name) not in (None, data):
                raise Mistake(f"there is another {name} on the panel: give yours another name")
            else:
                place.write(name, data)
                say(f"{name} is written.")


COMMANDS = {"get": get, "set": change, "edit": edit, "out": out, "in": bring}


def main():
    chosen = arguments(sys.argv[1:])
    try:
        COMMANDS[chosen.command](chosen)
    except Mistake as mistake:
        say(f"tools/settings: {mistake}")
        return WRONG
    except DeployError as error:
        say(f"tools/settings: {error}")
        return FAILED
    except OSError as error:
        say(f"tools/settings: {error.filename or chosen.file}: {error.strerror}")
        return FAILED
    except KeyboardInterrupt:
        say("tools/settings: interrupted")
        return FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main())
