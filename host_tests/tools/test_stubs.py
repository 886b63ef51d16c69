# SPDX-License-Identifier: MIT
"""The type stubs of the library have the names that it has, and pyrefly goes by them; and
`help()` of the bus tells every verb."""

import ast
import os

import pytest

import uss.bus
from pyrefly_bench import errors
from tiers import TOP
from uss.bus import verbs

INTERPRETERS = "host"

STUBS = TOP / "tools/pc/stubs"
SOURCES = {"uss": TOP / "firmware/uss", "uss_serial": TOP / "tools/pc/uss_serial"}
FAMILIES = TOP / "firmware/uss/families"
PATHS = sorted(path.relative_to(STUBS).as_posix() for path in STUBS.rglob("*.pyi"))

# Where what a stub tells stands in another file, which is loaded when it is named.
HOMES = {
    "uss/families/__init__.pyi": [FAMILIES / "__init__.py", *sorted(FAMILIES.glob("*.py"))],
    "uss_serial/__init__.pyi": [
        SOURCES["uss_serial"] / name for name in ("master.py", "link.py", "listing.py")
    ]
    + [TOP / "tools/port/errors.py"],
}
# Of a link what the engine alone calls, and of a family's modules what is theirs.
OF_THE_ENGINE = {"send", "send_as", "sending_us", "receive", "change_baud"}


def sources(stub):
    package, _, rest = stub.partition("/")
    return HOMES.get(stub) or [SOURCES[package] / rest.replace(".pyi", ".py")]


def parsed(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def is_public(name):
    return not name.startswith("_") or name == "__init__"


def signature(function):
    """Names of the arguments, and which have a default."""
    of = function.args
    named = [argument.arg for argument in of.args]
    return named, len(of.defaults), bool(of.vararg), bool(of.kwarg)


def classes(tree):
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}


def functions(body):
    """Name -> definition. A setter has the name of its property, which counts."""
    found = {}
    for node in body:
        if isinstance(node, ast.FunctionDef) and is_public(node.name):
            found.setdefault(node.name, node)
    return found


def is_property(function):
    return any(ast.unparse(one) == "property" for one in function.decorator_list)


def attributes(stub_class):
    return {node.target.id for node in stub_class.body if isinstance(node, ast.AnnAssign)}


def made(source_class):
    """What a class or its __init__ gives its objects."""
    found = {
        target.id
        for node in source_class.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(source_class):
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            if isinstance(node.value, ast.Name) and node.value.id == "self":
                found.add(node.attr)
    return {name for name in found if is_public(name)}


@pytest.mark.parametrize("stub", PATHS)
def test_a_stub_tells_what_is_there_and_nothing_else(stub):
    told = parsed(STUBS / stub)
    trees = [parsed(path) for path in sources(stub)]
    there, own = {}, {}
    for tree in trees:
        there |= {name: node for name, node in classes(tree).items() if is_public(name)}
        own |= {name: node for name, node in functions(tree.body).items()}
    for name, stub_class in classes(told).items():
        if is_public(name):
            compare(name, stub_class, there[name])
    for name, stub_function in functions(told.body).items():
        assert signature(stub_function) == signature(own[name]), name
    if stub not in HOMES:  # the modules of the others have names of their own besides
        assert set(classes(told)) == set(there)
        assert set(functions(told.body)) == set(own)


def compare(name, told, there):
    if name != "Master":  # that of uss_serial names its base as it likes
        assert [ast.unparse(one) for one in told.bases] == [
            ast.unparse(one) for one in there.bases
        ], name
    verbs_told, verbs_there = functions(told.body), functions(there.body)
    for verb, function in verbs_told.items():
        assert verb in verbs_there, f"{name}.{verb}"
        assert signature(function) == signature(verbs_there[verb]), f"{name}.{verb}"
        assert is_property(function) == is_property(verbs_there[verb]), f"{name}.{verb}"
    assert set(verbs_there) - set(verbs_told) - OF_THE_ENGINE <= {"__init__"}, name
    assert attributes(told) <= made(there), (name, attributes(told) - made(there))
    # The objects of the first three have more, for the engine; a family has what GENERIC has.
    if name not in ("Drive", "Master", "SerialLink") and not told.bases:
        assert made(there) == attributes(told), name


def test_every_family_has_a_stub():
    tree = parsed(STUBS / "uss/families/__init__.pyi")
    assert set(uss.bus.families.NAMES) <= set(classes(tree))
    generic = classes(tree)["GENERIC"]
    values = {name for name in vars(uss.bus.families.GENERIC) if is_public(name)}
    assert attributes(generic) == values


PROGRAM = """
from uss_serial import Master, SerialLink
from uss.bus import NotStarted
from uss.families import MM440, on_bop
from uss.layout import Layout
from uss.scaling import Scale

with Master(SerialLink("/dev/ttyUSB0", 19200), baud=19200) as bus:
    drive = bus.add(3, MM440, layout=Layout(4, 4), scale=Scale(50.0))
    bus.add(4, on_bop(MM440))
    drive.run(25.0)
    drive.run("fast")  # !
    drive.run(speed=25.0)  # !
    drive.start()  # !
    drive.hertz + 1.0
    drive.zsw + 1  # !
    bus.add("3")  # !
    bus.cycle_us = 200_000
    drive.is_running = True  # !
    MM440.baud_codes[7] + 1
    MM440.colour  # !
"""


def test_pyrefly_goes_by_the_stubs(tmp_path):
    config = 'project-includes = ["program.py", "stubs/**/*.pyi"]\nsearch-path = ["stubs"]\n'
    os.symlink(STUBS, tmp_path / "stubs")
    (tmp_path / "pyrefly.toml").write_text(config)
    (tmp_path / "program.py").write_text(PROGRAM)
    told = errors(folder=tmp_path)
    lines = [number for number, line in enumerate(PROGRAM.splitlines(), 1) if "# !" in line]
    found = [(os.path.basename(one["path"]), one["line"]) for one in told]
    assert sorted({*found}) == [("program.py", line) for line in lines], told


# ---- help() -----------------------------------------------------------------------------------


def called(rows):
    return [call.partition("(")[0] for call, _ in rows]


def test_help_tells_every_verb_once(capsys):
    source = classes(parsed(TOP / "firmware/uss/bus/__init__.py"))
    for name, rows in (("Master", verbs.BUS), ("Drive", verbs.DRIVE)):
        there = set(functions(source[name].body)) - {"__init__"}
        assert sorted(called(rows)) == sorted(there), name
    uss.bus.help()
    printed = capsys.readouterr().out.splitlines()
    assert len(printed) == len(verbs.BUS) + len(verbs.DRIVE)
    assert all(len(line) < 100 for line in printed)
    assert "drive.run(hertz)                 turn the motor; also percent= or rpm=" in printed
