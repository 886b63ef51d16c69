# SPDX-License-Identifier: MIT
"""Copies of the tree, in which tests run while something of the firmware is changed.

scratch(tree, folder)     # the same files; its build/ is that of the tree, but for the Pico's
"""

import shutil

OWN = ("build", ".git")
PYTHON_LEFT = shutil.ignore_patterns("__pycache__", "*.egg-info", ".pytest_cache")
# The Pico's firmware is built anew from the copy, and the compilation is a place of its own. What
# the tests of the tree import, compiled, is not what is in the copy.
BUILT_THERE = ("pico_make", "compiled", "mutants", "lock", "fetched.log")
BUILT_ON = ("pico", "blocks")  # what is there is good until the firmware is another one


def scratch(tree, folder):
    """Make the copy, or bring it up to date."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        if path.name not in OWN:
            remove(path)
    for path in tree.iterdir():
        if path.name in OWN:
            continue
        if path.is_dir():
            shutil.copytree(path, folder / path.name, ignore=PYTHON_LEFT)
        else:
            shutil.copy2(path, folder / path.name)
    (folder / "build").mkdir(exist_ok=True)
    for path in (tree / "build").iterdir():
        link = folder / "build" / path.name
        if path.name in BUILT_ON:
            if link.exists():
                remove(link)
            shutil.copytree(path, link)
        elif path.name not in BUILT_THERE and not link.is_symlink():
            link.symlink_to(path)
    return folder


def remove(path):
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink()
