# SPDX-License-Identifier: MIT
"""What `uss.bus.help()` prints: every verb of a bus and of a drive.

A row: how it is called, what it does. MicroPython keeps no docstrings on a chip.
"""

BUS = (
    ("add(address, family)", "a drive more, or one more turn for it; answers the Drive"),
    ("remove(drive)", "take it off the list; it has to stand"),
    ("arrange(drives)", "make the circulating list anew"),
    ("readdress(drive, address)", "it answers there from now on"),
    ("supervise(drive, ms)", "tell the telegram-off time of one that cannot be asked"),
    ("step()", "do what is due: again and again, or motors stop after 300 ms"),
    ("rest()", "a step and a tenth of a millisecond"),
    ("wait(seconds, until)", "keep the bus going so long, or until it is true"),
    ("pace(Pacer, timer)", "let interrupts keep it going"),
    ("stop_all()", "OFF1 to all, a telegram each"),
    ("broadcast_stop()", "OFF1 to all in one telegram, then to each"),
    ("mirror(node)", "whether it sends a mirror telegram back"),
    ("post(telegram)", "send a telegram outside the list"),
    ("off()", "stop all and leave the line"),
    ("on()", "take the line again"),
    ("close()", "stop all, wait for the answers, leave line and link"),
    ("is_silent()", "whether it sends nothing any more"),
    ("why_silent()", "why, in words"),
    ("is_line_in_use()", "whether another master was heard"),
    ("has_echo()", "whether the line echoes"),
    ("counters()", "of all drives together"),
    ("status()", "error status word of all drives"),
    ("round_us()", "how long a round takes"),
    ("cycle_us", "least time of a round; may be set"),
    ("retries", "repetitions without a valid reply; may be set"),
    ("foreign", "what was heard from another master"),
)
DRIVE = (
    ("run(hertz)", "turn the motor; also percent= or rpm="),
    ("set(hertz)", "a new speed if it runs; starts nothing"),
    ("jog_right()", "jog until stop()"),
    ("jog_left()", "the other way"),
    ("stop()", "OFF1: ramp down"),
    ("off2()", "coast"),
    ("off3()", "as fast as it can"),
    ("acknowledge()", "acknowledge a fault"),
    ("supervise(seconds)", "write the telegram-off time, P2014"),
    ("read(number, index)", "a parameter"),
    ("write(number, value)", "into RAM; eeprom=True also there, sure=True for the risky ones"),
    ("do(job)", "a job of uss.pkw, uss.tasks; waits"),
    ("ask(job)", "the same without waiting"),
    ("carry_out(job)", "as do(), and raises nothing when it is refused"),
    ("begin(job)", "wait for contact and hand it in"),
    ("finish(job)", "wait for its end"),
    ("raise_unless_done(job)", "the exception that fits its end"),
    ("addressed(job)", "with the task that the index wants"),
    ("keep_within(ms)", "the bus keeps within that telegram-off time"),
    ("control(bits, on)", "bits 3...6 and 13...15 of STW"),
    ("put(place, word)", "a PZD word to it"),
    ("word(place)", "a PZD word from it"),
    ("state", "ready, running, fault, inhibited, not ready, no contact ..."),
    ("is_running", "it says that it runs"),
    ("is_on()", "whether it is told to run"),
    ("contact", "it answers"),
    ("hertz", "actual speed; also percent, rpm"),
    ("percent", "of the reference"),
    ("rpm", "1/min without slip"),
    ("fault", "number of the fault, 0 for none"),
    ("zsw", "status word"),
    ("hiw", "actual value, as it came"),
    ("address", "0...31"),
    ("layout", "of its telegrams"),
    ("counters", "a figure for each name in uss.drive.COUNTERS"),
    ("status", "error status word"),
    ("silent", "telegrams without a valid reply in a row"),
    ("trouble", "what came instead of replies"),
)


def tell():
    for name, verbs in (("bus", BUS), ("drive", DRIVE)):
        for call, what in verbs:
            print("%s.%-26s %s" % (name, call, what))
