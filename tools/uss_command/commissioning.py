# SPDX-License-Identifier: MIT
"""commission: the steps of the catalogue, one by one, asked and checked.

    uss: what a drive needs to obey the bus     reset: factory settings     motor: its rating

Each step shows what the drive has, and what it should have. Enter takes what stands in brackets,
another value takes that, s leaves the step out, q ends. It says in the end what is left.
"""

import sys
import threading

import catalogue
from tools.uss_command.errors import FAILED, Failure, Misused
from tools.uss_command.facts import ENCODING, number_of, parameter
from tools.uss_command.line import Line, Node
from tools.uss_command.parameters import writing
from tools.uss_command.sets import check_stands
from uss import families, pkw
from uss.bus.pkw_errors import error_text

PROCEDURES = {"uss": 1, "reset": 2, "motor": 3}
OFF_TIME_MS = 2000
LONG_TRIES = 40  # looks at a drive that is busy for 10 s or more
LOOK_S = 0.5
KEEP_S = 0.1
BUSY = (970, 3900)  # the drive says nothing for a while after these
STAYS = "@baud", "@address"  # what the drive answers by now is right already


def add(commands):
    parser = commands.add_parser("commission", help="step by step: what USS, or the motor, needs")
    parser.add_argument("family", choices=catalogue.FAMILIES, metavar="FAMILY",
                        help=" ".join(catalogue.FAMILIES))  # fmt: skip
    parser.add_argument("--steps", choices=PROCEDURES, default="uss", help="(%(default)s)")
    parser.add_argument("--set", action="append", default=[], metavar="P0304=400",
                        help="an answer; with --yes all others are as proposed")  # fmt: skip
    parser.add_argument("--yes", action="store_true", help="do not ask")
    parser.add_argument(
        "--eeprom", action="store_true", help="RAM and EEPROM; RAM alone otherwise"
    )
    parser.set_defaults(run=commission)


def commission(screen, settings, chosen):
    answers = {}
    for word in chosen.set:
        name, equals, value = word.partition("=")
        if not equals:
            raise Misused("--set: %s is no answer such as P0304=400" % word)
        answers[parameter(name)] = value
    if not chosen.yes and not sys.stdin:
        raise Misused("nobody can answer here: --yes")
    with Line(screen, settings, chosen) as line:
        line.listen()
        node = _node(line, settings, chosen.family)
        check_stands(line, node)
        course = Course(screen, line, node, answers, chosen)
        course.walk(catalogue.steps(chosen.family, PROCEDURES[chosen.steps]))
    for text in course.left:
        screen.event("left: %s" % text, left=text)
    screen.event("%d steps done, %d left" % (course.done, len(course.left)),
                 done=course.done, left=len(course.left))  # fmt: skip
    return FAILED if course.left else 0


def _node(line, settings, name):
    """The drive, which must be of this family as far as anybody can tell. Failure."""
    node = line.node(settings.the_address())
    if settings.kind(node.address) or node.facts.catalogue == name:
        return node
    same = name.startswith("mm4") and str(node.facts.catalogue).startswith("mm4")
    if node.facts.catalogue is not None and not same:
        raise Failure("drive %d is a %s, not a %s" % (node.address, node.family.name, name))
    return Node(node.address, getattr(families, name.upper()), node.layout, line.mask)


class Leave(Exception):
    """Somebody has had enough."""


class Course:
    """done: how many steps. left: those that were not done, in words."""

    def __init__(self, screen, line, node, answers, chosen):
        self.done = 0
        self.left = []
        self._screen = screen
        self._line = line
        self._node = node
        self._answers = answers
        self._chosen = chosen

    def walk(self, steps):
        is_over = False
        for step in list(steps):
            name = step[catalogue.NAME].decode(ENCODING)
            number, index = int(step[catalogue.STEP_NUMBER]), int(step[catalogue.STEP_INDEX])
            label = "%s %s" % (self._node.facts.label(number, index), name)
            if is_over:
                self.left.append(label)
                continue
            try:
                reason = self._step(step, label, number, index)
            except Leave:
                is_over, reason = True, "not done"
            if reason:
                self.left.append("%s: %s" % (label, reason))
            else:
                self.done += 1

    def _step(self, step, label, number, index):
        """Why it is left, or None."""
        node = self._node
        job = self._line.ask(node, pkw.read(number, index))
        if job.state == pkw.REFUSED:
            return error_text(job.error)
        kind = node.facts.kind(job)
        has = node.facts.of_words(kind, job)
        value = self._wanted(step[catalogue.STEP_VALUE].decode(), number, has)
        answer = self._answers.get((number, index))
        if answer is None and not self._chosen.yes:
            answer = self._ask(step, label, node.facts.shown(number, has, kind), value)
        if answer == "s":
            return "left out"
        if answer:
            value = number_of(answer, kind)
        if value is None:
            return "nobody has told it"
        if value != has or number in BUSY:
            job = self._line.ask(node, writing(node, number, index, value, kind, self._eeprom()))
            if job.state == pkw.REFUSED:
                return "%s is refused: %s" % (value, error_text(job.error))
            if number in BUSY:
                self._wait()
        self._screen.event("%s = %s" % (label, node.facts.shown(number, value, kind)),
                           parameter=label, value=value, before=has)  # fmt: skip

    def _eeprom(self):
        return self._chosen.eeprom and self._node.family.has_eeprom_tasks

    def _wanted(self, word, number, has):
        """The value that a step proposes."""
        node = self._node
        if word in STAYS or word == "?":
            return has
        if word == "@pkw":
            return node.layout.pkw_words
        if word == "@off":
            unit_ms = node.family.off_time_unit_ms
            return has or max(OFF_TIME_MS // unit_ms, 1)
        return catalogue.value(word.encode())

    def _ask(self, step, label, has, value):
        note = step[catalogue.STEP_NOTE].decode(ENCODING)
        print("\n%s\n  %s\n  the drive has %s" % (label, note, has))
        answer = self._typed("  [%s], another value, s or q: " % value)
        if answer in (None, "q"):
            raise Leave
        return answer

    def _typed(self, prompt):
        """What somebody types, who may take his time: the drive hears something meanwhile. None:
        nobody types any more."""
        typed = []

        def read():
            try:
                typed.append(input(prompt).strip())
            except (EOFError, OSError, ValueError):
                typed.append(None)

        threading.Thread(target=read, daemon=True).start()
        while not typed:
            self._line.rest(KEEP_S, lambda: bool(typed))
            if not typed:
                self._line.visit(self._node)
        return typed[0]

    def _wait(self):
        """Until the drive answers again."""
        for _ in range(LONG_TRIES):
            self._line.rest(LOOK_S)
            if self._line.visit(self._node):
                return
        raise Failure("drive %d does not answer any more" % self._node.address)
