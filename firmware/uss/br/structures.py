# SPDX-License-Identifier: MIT
"""The structures of the B&R project, with the names of its members.

A list that is numbered from 1 there has a place 0 here that nobody uses: PZD[1] is PZD1.

    setup = DriveSetup()
    setup.PZD.Run = True
    setup.Lengh.PKW_lengh = 4           # "Lengh" is how the source writes it
"""

from micropython import const

ADDRESSES = const(32)
SEQUENCE_MAX = const(255)
RESTART = const(255)  # in ControllSequence: begin again with the first entry
PKW_MAX = const(126)
PZD_MAX = const(16)
BUFFER = const(256)

# DriveData[adr].StatusWord: bits 0...15 of the status word, in this order.
STATUS_WORD = (
    "DriveReady", "DriveReadyToRun", "DriveRunning", "DriveFault", "OFF2", "OFF3", "ONInhibit",
    "DriveWarning", "DeviationSetpoint", "PZDControl", "FreqOverMax", "Warning",
    "MotorHoldingBreake", "MotorOverload", "MotorRunsRight", "InverterOverload",
)  # fmt: skip


class Commands:
    """What is wanted of the drive. Freq, RefFreq: Hz; a negative Freq turns left."""

    def __init__(self):
        self.Run = False
        self.FaultAcknowledge = False
        self.JOGRight = False
        self.JOGLeft = False
        self.Reverse = False
        self.RefFreq = 50.0
        self.Freq = 0.0


class Lengths:
    """How a telegram is divided, in words; as P2013 and P2012 of the drive say."""

    def __init__(self):
        self.PKW_lengh = 127
        self.PZD_lengh = 2


class DriveSetup:
    """DriveSetup[adr]: of the drive with this address, set by the program at any time. The lengths
    are at first those of the drive of the source, a G110."""

    def __init__(self):
        self.PZD = Commands()
        self.Lengh = Lengths()


class DriveSequence:
    """ControllSequence: addresses, in the order in which the drives are asked; it ends with
    RESTART. ADDR: the drive whose data came last."""

    def __init__(self):
        self.ControllSequence = [RESTART] * (SEQUENCE_MAX + 1)
        self.ADDR = 0


class StatusWord:
    """The bits of the status word, True for 1: OFF2, OFF3, DeviationSetpoint, Warning,
    MotorOverload and InverterOverload are in force when they are False (table 2.2 of the source).
    """

    def __init__(self):
        self.DriveReady = False
        self.DriveReadyToRun = False
        self.DriveRunning = False
        self.DriveFault = False
        self.OFF2 = False
        self.OFF3 = False
        self.ONInhibit = False
        self.DriveWarning = False
        self.DeviationSetpoint = False
        self.PZDControl = False
        self.FreqOverMax = False
        self.Warning = False
        self.MotorHoldingBreake = False
        self.MotorOverload = False
        self.MotorRunsRight = False
        self.InverterOverload = False

    def take(self, word):
        """The bits of this word."""
        for place, name in enumerate(STATUS_WORD):
            setattr(self, name, word >> place & 1 == 1)


class ActualValue:
    """HEX: HIW as it came. Percent: of the reference frequency. Freq: Hz. Both have a sign."""

    def __init__(self):
        self.HEX = 0
        self.Percent = 0.0
        self.Freq = 0.0


class RxPZD:
    """What RxCreatePZD makes of a telegram."""

    def __init__(self):
        self.StatusWord = StatusWord()
        self.ActualValue = ActualValue()


class Receive:
    """Receive: the drive's last telegram was answered. ErrorID, which the source does not have:
    why not, a code of `codes`."""

    def __init__(self):
        self.Receive = False
        self.ErrorID = 0


class DriveData(RxPZD):
    """DriveData[adr]: what the drive with this address has told, as long as it was heard."""

    def __init__(self):
        super().__init__()
        self.Status = Receive()


class Percent:
    """Percent: of the reference frequency."""

    def __init__(self):
        self.Percent = 0.0


class TxPZD:
    """From Par, TxCreatePZD makes ControlWord and MainSetpoint."""

    def __init__(self):
        self.ControlWord = 0
        self.MainSetpoint = Percent()
        self.Par = Commands()


class Frame:
    """What stands around the words of a telegram."""

    def __init__(self):
        self.STX = 0x02
        self.LGE = 0
        self.BCC = 0
        self.ADR = 0


class Body:
    """The words of a telegram, PKW[1...126] and PZD[1...16]."""

    def __init__(self):
        self.PKW = [0] * (PKW_MAX + 1)
        self.PZD = [0] * (PZD_MAX + 1)


class TelegramSetup(Lengths):
    """ADR: of a telegram to be sent. RefFreq: of one received, Hz."""

    def __init__(self):
        super().__init__()
        self.ADR = 0
        self.RefFreq = 50.0


class Telegram:
    """TxTlg and RxTlg. The source has ADR in Par of the first, and in Frame of the second."""

    def __init__(self):
        self.Frame = Frame()
        self.Body = Body()
        self.Par = TelegramSetup()
