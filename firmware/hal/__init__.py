# SPDX-License-Identifier: MIT
"""What a board gives the panel: small contracts, and drivers that fulfil them.

A driver is handed the objects of the chip (UART, Pin, Timer ...) and uses them; it imports no
`machine` and can therefore run on the simulated chip, the same bytes. A board file
(`boards/<name>/board.py`) builds the objects and is the only place that knows pins. The app takes
the board as it is and builds no hardware.

A contract is a duck type: any object with these names that keeps these promises will do.
"Interrupt" means that the caller may be a hard interrupt: the method allocates nothing and uses no
float.

board
    name                text, at most 16 characters
    reset_cause         "" after power-on or a restart that was wanted, "WATCHDOG" after it bit
    clock               see below
    display, keypad, store, watchdog   see below
    timer               a machine.Timer for the bus alone; None: the main loop paces the bus, and
    if
                        it hangs, only the watchdog stops the drives
    backlight(on)       optional, or None: switches the light of the display, on at first
    make_link(baud)     builds the link for that baud rate; called once
    serial()            optional, or None: the `hal.serial.Serial` on which a PC listens, the same
                        one each time
    must_supervise      optional; True: no drive starts whose own time-out is off, or unread: this
                        board cannot stop it when its program hangs outside Python
    idle()              at the end of each main loop step: lets the machine work, 2 ms at most

clock
    ticks_us() -> int   interrupt. Microseconds since some instant; wraps to 0 after ticks_mask
    ticks_ms() -> int   milliseconds, wraps to 0 after ticks_mask
    ticks_mask          period - 1 of both: 2**n - 1, at most 2**30 - 1 (small integers have 31
                        bits), at least 2**24 - 1 (half a period outlasts every time-out)
    sleep_us(us)        wait so long or a little longer, 100 us at most; interrupts are served

link                    half duplex; the driver enable is the link's affair
    clock               the board's: that of sent_at and received_at
    interrupts          True: on_activity is called without anyone asking; False: it must be polled
    resolution_us       how late received_at and sent_at may be, at the most
    on_activity         a function of no arguments, at first one that does nothing. The link calls
                        it (interrupt) when a burst of characters has ended, and, if it is not
                        `foreseen`, when sending has ended. No jump comes before the call:
                        MicroPython raises a pending Ctrl-C at the next jump, and disables an
                        interrupt handler that raises for good
    send(buffer, count) interrupt. Begins to send the first `count` characters; the caller
                        leaves the buffer alone until sending_us answers 0
    sending_us(now_us)  interrupt. Microseconds until the last stop bit has left and the driver is
                        off, at least 1; 0 when that is over
    sent_at             clock.ticks_us() of that instant
    defect              optional; what it found wrong with itself when it was made: "", or of
                        hal.link.rp2_check.DEFECTS
    stack_bytes         optional; how deep the program may be in the stack on which on_activity is
                        called, if there is a place where it leaves too little for the engine
    foreseen            optional; True: sent_at holds as soon as `send` has returned
    receive(buffer, at) -> int   interrupt. Moves what was received to buffer[at:], as far as there
                        is room, and answers how many characters. The caller must process them: a
                        look may use up the interrupt that would have announced them. -1:
                        characters are coming in, and on_activity will announce their end; the link
                        hands over none before.
    received_at         clock.ticks_us() of the end of the last of them
    close()             driver off, nothing sent any more, no interrupt left
    goes_on             optional; True: the link can send the next telegram by itself as soon as
                        the reply is complete, and has these four methods as well
    instruct(buffer, says_nothing_new, plan, attention)   called once, before `prepare`: where a
                        reply goes that is looked at, and the function that does it (see
                        uss.going_on), which gets the plan and the attention
    prepare(request, size, telegram, count, after_us)   interrupt. When the `size` characters of
                        the reply to `request` are there, not sooner than after_us after it, and
                        says_nothing_new(buffer, size, request, plan, attention), the link sends
                        the first `count` characters of `telegram`; it makes a copy of them now.
                        `receive` answers `size` then, and nothing has been moved
    take_back()         interrupt. It does not do so any more
    follow() -> bool    interrupt. Whether it has done so since the last call

timer                   of the chip: init(mode=timer.ONE_SHOT, period=us, tick_hz=1_000_000,
                        callback=function of the timer), deinit(). Both: interrupt.

display
    rows, columns       2 and 16
    rom                 optional; the characters that it has: "A00", as if it were missing, or
                        "A02", which has accented letters at the codes of ISO 8859-1
    define(glyphs)      before the first show: the pictures of character codes 0...7, 8 bytes each,
                        one for every row of dots from the top, bit 4 the leftmost of 5
    show(picture)       picture: bytearray of 32 character codes, row by row. Brings the display a
                        bounded piece (<= 1 ms of work) nearer to it; answers whether all is shown

keypad
    names               names of the keys, in the order of their bits: "START", "STOP", ...
    read() -> int       the keys that are down now, as bits. If the reading of a matrix is
                        ambiguous, none of its keys count; keys with a pin of their own, such as
                        STOP, still do.
    unclear             the keys, as bits, that the last reading could not determine; mostly 0

store                   keeps files over power cuts; any method may raise OSError. One small file:
    read(most=-1) -> bytes or None   the first `most` bytes; -1: all
    replace(data)       all or nothing: after a power cut either the old or the new data are there
    set_aside()         keep what is there under another name, for a person to look at
                        and larger ones beside it, each with a name:
    names(ending)       of those that end like this, in order
    open(name)          to be read: read(most), close()
    begin() -> file     a new one: write(data). Until `finish` nobody finds it
    finish(file, name)  all or nothing: in place of the one that had this name
    remove(name)

watchdog
    feed()              the first call starts it; 2 s without a further call restart the chip
    stop() -> bool      no restart until the next feed(); False if the chip cannot do that
"""
