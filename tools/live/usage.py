# SPDX-License-Identifier: MIT
"""The options of ./tools/panel, for --help. Before there is a MicroPython, CPython shows them."""

from boards.sim.drives import kinds

USAGE = """\
usage: ./tools/panel [--speed N] [--drives 1,2=g110] [--baud 19200] [--settings FILE] ...
       ./tools/panel --script FILE|- ...
       ./tools/panel --board pico [--flash FILE] ...
       ./tools/panel --port PATH [--reply-timeout MS] [--script FILE|-] ...
       ./tools/panel --web [--bind ADDRESS] [--web-port N] ...
       ./tools/panel --web --static FOLDER [--drives LIST] [--baud RATE] [--keys WIRING] [--seed N]
       ./tools/panel --join LINK
       ./tools/panel --lines ...

  --speed N       in a terminal: time passes N times as fast, 1...100 (1)
  --script FILE   do the commands in FILE, or from standard input (-), in virtual time
  --web           serve the panel to a browser, and print the link
  --bind ADDRESS  web: serve it on this address (127.0.0.1, which is this computer alone)
  --web-port N    web: on this port; 0 takes a free one (0)
  --static FOLDER web: write the page into FOLDER, with a panel that runs in the browser itself and
                  needs no server of ours
  --join LINK     be one more front end of the panel whose link --web has printed, in a terminal
  --lines         for a front end of your own: speak tools/live/README.md on standard input and
                  output, in real time
  --drives LIST   the simulated drives (1, or those of the settings): addresses 0...31, and what is
                  there, if it is no mm420: 1,2=g110,3=v20/4,4=mm440/4+4,8=mm420/factory
                  families: %s
                  /0 /3 /4 /127: PKW words, if not as usual; +4: PZD words; /factory: a drive as
                  delivered, of which the panel is not told; mm440-bop: USS on its BOP link
  --baud RATE     baud rate of the line and its drives (19200, or that of the settings)
  --settings FILE keep the panel's settings in FILE; otherwise they end with the program. The panel
                  looks for the drives in FILE, whichever --drives simulates
  --unset         the panel has no settings yet, as at its first power-on; with --settings, FILE
                  must be a new one
  --json FILE     the panel's log, a line of JSON a second, goes on at the end of FILE. It is on,
                  unless a FILE of --settings is there already and says otherwise
  --keys WIRING   direct: each key has a pin of its own; matrix: all but START and STOP;
                  compact: eight keys in place of fourteen (direct)
  --seed N        other reply delays and loop times; 0 is the plain world (0)
  --polled        no receive interrupt: the link is polled
  --board BOARD   sim: the simulated board; pico: the firmware file for the Raspberry Pi Pico on an
                  emulated one (sim). Not with --settings, --unset, --json, --polled,
                  --keys
  --flash FILE    pico: keep the chip's flash in FILE, and with it the settings of the panel
  --display KIND  pico: wires, four data lines, or backpack, on I2C (wires)
  --port PATH     talk to real drives on this serial port, which is set to 8E1 at --baud, or on a
                  pty, in real time; wait and hold in a script take theirs. --drives are those that
                  the panel looks for, families what it expects there. Not with --speed, --seed,
                  --unset, --polled, --board
  --reply-timeout MS
                  port: how long a drive may take to answer, 20...500, the adapter's own delay
                  included (60, or that of the settings). It delays a STOP as well
  -h, --help      this text
  --version       alone: the version of the panel
A simulated mm420 knows the rates from 1200 to 115200; others know fewer, or more.
An emulated Pico tells the path of its USB serial port, for mpremote and tools/deploy.
Without --script, in a terminal: the live panel. It shows its keys; q ends it.""" % (
    " ".join(kinds.NAMES)
)


if __name__ == "__main__":
    print(USAGE)
