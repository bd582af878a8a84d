#!/usr/bin/env python3
"""The makers' own Python libraries on the simulated bus: `makers.py DIALRIG [MODEL...]`.

For every model they know: find it, ask what it is, give it another number and speed, read, write, register and act,
write and read several at once. They know nothing of this project; addresses are theirs, from the makers' manuals.
Where a library is known to be wrong, its wrong behaviour is asserted with the reason, so that a mended version is
noticed. Needs `requirements.txt` and the program DIALRIG. Exits 1 at the first thing that is not so.
"""

import os
import subprocess
import sys
import tempfile
import time

import dynamixel_sdk as dxl
import scservo_sdk as scs

BAUD = 1_000_000
IDS = (1, 2, 3)
# How often something is tried that fails only where the machine stops us for longer than a library waits.
TRIES = 10


class Family:
    """What one control table looks like: addresses and sizes of what is used here."""

    def __init__(self, protocol, number, ident, baud, speed, torque, spare, goal, present, lock=None):
        self.protocol = protocol  # 2.0 and 1.0 of ROBOTIS, "sts" and "scs" of Feetech
        self.number = number  # address of the model number
        self.ident = ident
        self.baud = baud
        self.speed = speed  # what the baud register holds for 57600
        self.torque = torque
        self.spare = spare  # a byte that may hold 1
        self.goal = goal
        self.present = present
        self.lock = lock


X = Family(2.0, 0, 7, 8, 1, 64, 65, (116, 4), (132, 4))
XL320 = Family(2.0, 0, 3, 4, 1, 24, 25, (30, 2), (37, 2))
AX = Family(1.0, 0, 3, 4, 34, 24, 25, (30, 2), (36, 2))
# The vendor's own numbers: 6 is 57600 (`SCS_57600`), where others count 76800 not and have 5.
STS = Family("sts", 3, 5, 6, 6, 40, 41, (42, 2), (56, 2), lock=55)
SCS = Family("scs", 3, 5, 6, 6, 40, 41, (42, 2), (56, 2), lock=48)

MODELS = {
    "xl330-m288": (X, 1200, 2048),
    "xl330-m077": (X, 1190, 2048),
    "xl430-w250": (X, 1060, 2048),
    "xm430-w350": (X, 1020, 2048),
    "xm540-w270": (X, 1120, 2048),
    "mx-28-2": (X, 30, 2048),
    "xl-320": (XL320, 350, 512),
    "mx-28": (AX, 29, 2048),
    "ax-12a": (AX, 12, 512),
    "sts3215": (STS, 777, 2048),
    "sts3250": (STS, 2825, 2048),
    "scs0009": (SCS, 1284, 512),
}
FAST = {"xl330-m288", "xl330-m077", "xl430-w250", "xm430-w350", "xm540-w270"}


def patiently(what, act):
    """Tries until it gives something else than None; what it gives."""
    for _ in range(TRIES):
        done = act()
        if done is not None:
            return done
        time.sleep(0.05)
    raise AssertionError(f"{what}: failed {TRIES} times")


def same(what, got, expected):
    if got != expected:
        raise AssertionError(f"{what}: expected {expected}, got {got}")


class Bus:
    """A simulated bus and the library that drives it."""

    def __init__(self, dialrig, model, folder):
        self.model = model
        self.family, self.number, self.centre = MODELS[model]
        self.is_feetech = self.family.protocol in ("sts", "scs")
        path = os.path.join(folder, model)
        servos = f"{model}:{IDS[0]}-{IDS[-1]}"
        command = [dialrig, "sim", "servo-bus", "--servo", servos, "--pty", path, "--baud", str(BAUD)]
        # It takes orders from standard input until that ends; here it has none.
        self.program = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        line = self.program.stdout.readline().strip()
        same(f"{model}: first line", line, f"ready {path}")
        library = scs if self.is_feetech else dxl
        self.port = library.PortHandler(path)
        if not (self.port.openPort() and self.port.setBaudRate(BAUD)):
            raise AssertionError(f"{model}: the library cannot open {path}")
        if self.is_feetech:
            self.packets = scs.PacketHandler(0 if self.family.protocol == "sts" else 1)
        else:
            self.packets = dxl.PacketHandler(self.family.protocol)
        # Sizes of one value and the library's own ways to ask for it.
        self.reads = {
            1: self.packets.read1ByteTxRx,
            2: self.packets.read2ByteTxRx,
            4: self.packets.read4ByteTxRx,
        }
        self.writes = {
            1: self.packets.write1ByteTxRx,
            2: self.packets.write2ByteTxRx,
            4: self.packets.write4ByteTxRx,
        }

    def close(self):
        self.port.closePort()
        self.program.terminate()
        self.program.wait(timeout=10)

    def read(self, ident, at):
        address, size = at

        def act():
            value, result, error = self.reads[size](self.port, ident, address)
            return value if (result, error) == (dxl.COMM_SUCCESS, 0) else None

        return patiently(f"{self.model}: read {address} of {ident}", act)

    def write(self, ident, at, value):
        address, size = at

        def act():
            result, error = self.writes[size](self.port, ident, address, value)
            return True if (result, error) == (dxl.COMM_SUCCESS, 0) else None

        patiently(f"{self.model}: write {address} of {ident}", act)

    def there(self, ident):
        """The model number that a ping gives, or nothing."""
        number, result, _ = self.packets.ping(self.port, ident)
        return number if result == dxl.COMM_SUCCESS else None

    def words(self, value, size):
        """A value as the library wants it in a group: bytes, in the order of the servo."""
        low = [value >> 8 * at & 0xFF for at in range(size)]
        return low[::-1] if self.family.protocol == "scs" else low


def finds(bus):
    for ident in IDS:
        number = patiently(f"{bus.model}: ping {ident}", lambda ident=ident: bus.there(ident))
        same(f"{bus.model}: number of {ident}", number, bus.number)
    same(f"{bus.model}: ping of nobody", bus.there(4), None)
    if bus.family.protocol != 2.0:
        return
    found = patiently(
        f"{bus.model}: broadcast ping",
        lambda: (lambda answers, _: answers if len(answers) == len(IDS) else None)(
            *bus.packets.broadcastPing(bus.port)
        ),
    )
    same(f"{bus.model}: broadcast ping", {ident: told[0] for ident, told in found.items()},
         {ident: bus.number for ident in IDS})


def reads_and_writes(bus):
    spare = (bus.family.spare, 1)
    same(f"{bus.model}: model number read", bus.read(2, (bus.family.number, 2)), bus.number)
    bus.write(2, spare, 1)
    same(f"{bus.model}: what was written", bus.read(2, spare), 1)
    # Registered, and acted upon.
    packets = bus.packets
    patiently(
        f"{bus.model}: reg write",
        lambda: True if packets.regWriteTxRx(bus.port, 2, spare[0], 1, [0])[0] == dxl.COMM_SUCCESS else None,
    )
    same(f"{bus.model}: registered only", bus.read(2, spare), 1)
    packets.action(bus.port, 0xFE)
    same(f"{bus.model}: acted upon", bus.read(2, spare), 0)


def is_refused(bus):
    """A write that the servo does not take is told as an error; Feetech's servos have none to tell."""
    address, size = bus.family.present

    def act():
        result, error = bus.writes[size](bus.port, 2, address, 5)
        return (error,) if result == dxl.COMM_SUCCESS else None

    (error,) = patiently(f"{bus.model}: a refusal", act)
    expected = {2.0: 7, 1.0: 1 << 3}.get(bus.family.protocol, 0)
    same(f"{bus.model}: error of a write to what is read only", error, expected)


def moves_together(bus):
    family, library = bus.family, scs if bus.is_feetech else dxl
    goals = dict(zip(IDS, (bus.centre - 40, bus.centre + 30, bus.centre + 90)))
    for ident in IDS:
        bus.write(ident, (family.torque, 1), 1)
    group = library.GroupSyncWrite(bus.port, bus.packets, *family.goal)
    for ident, goal in goals.items():
        group.addParam(ident, bus.words(goal, family.goal[1]))
    group.txPacket()
    deadline = time.monotonic() + 30
    while any(bus.read(ident, family.present) != goal for ident, goal in goals.items()):
        if time.monotonic() > deadline:
            raise AssertionError(f"{bus.model}: the servos are not where they were sent")
    reads_together(bus, goals)


def reads_together(bus, goals):
    family, library = bus.family, scs if bus.is_feetech else dxl
    address, size = family.present

    def same_data(group):
        return {ident: group.getData(ident, address, size) for ident in goals}

    if family.protocol in (2.0, "sts"):
        group = library.GroupSyncRead(bus.port, bus.packets, address, size)
        for ident in goals:
            group.addParam(ident)
        patiently(f"{bus.model}: sync read", lambda: True if group.txRxPacket() == dxl.COMM_SUCCESS else None)
        same(f"{bus.model}: sync read", same_data(group), goals)
        if bus.model in FAST:
            patiently(
                f"{bus.model}: fast sync read",
                lambda: True if group.fastSyncRead() == dxl.COMM_SUCCESS else None,
            )
            same(f"{bus.model}: fast sync read", same_data(group), goals)
    if family.protocol == 2.0:
        group = dxl.GroupBulkRead(bus.port, bus.packets)
        for ident in goals:
            group.addParam(ident, address, size)
        patiently(f"{bus.model}: bulk read", lambda: True if group.txRxPacket() == dxl.COMM_SUCCESS else None)
        same(f"{bus.model}: bulk read", same_data(group), goals)
    if family.protocol == 1.0:
        bulk_reads_with_protocol_1(bus, goals)


def bulk_reads_with_protocol_1(bus, goals):
    """An MX knows it, an AX does not."""
    address, size = bus.family.present
    group = dxl.GroupBulkRead(bus.port, bus.packets)
    for ident in goals:
        group.addParam(ident, address, size)
    try:
        group.txRxPacket()
    except TypeError:
        # Known fault of dynamixel-sdk 4.1.0: its group hands its handler of protocol 1.0 one argument too many.
        pass
    else:
        raise AssertionError(f"{bus.model}: bulk read with protocol 1.0 is mended")
    # The packet itself it can send.
    params = [byte for ident in goals for byte in (size, ident, address)]

    def act():
        bus.packets.bulkReadTx(bus.port, params, len(params))
        told = {}
        for ident in goals:
            data, result, error = bus.packets.readRx(bus.port, ident, size)
            if (result, error) != (dxl.COMM_SUCCESS, 0):
                return None
            told[ident] = data[0] | data[1] << 8
        return told

    if bus.model == "mx-28":
        same("mx-28: bulk read", patiently("mx-28: bulk read", act), goals)
    else:
        same(f"{bus.model}: a bulk read", act(), None)


def is_configured(bus):
    family = bus.family
    for ident in (1, 3):
        bus.write(ident, (family.torque, 1), 0)
        if family.lock is not None:
            bus.write(ident, (family.lock, 1), 0)
    time.sleep(0.1)
    bus.writes[1](bus.port, 3, family.ident, 9)
    time.sleep(0.1)
    same(f"{bus.model}: new number", patiently(f"{bus.model}: ping 9", lambda: bus.there(9)), bus.number)
    same(f"{bus.model}: old number", bus.there(3), None)
    bus.writes[1](bus.port, 1, family.baud, family.speed)
    time.sleep(0.1)
    bus.port.setBaudRate(57_600)
    same(f"{bus.model}: new speed", patiently(f"{bus.model}: ping at 57600", lambda: bus.there(1)), bus.number)
    same(f"{bus.model}: the others", bus.there(2), None)


def does_not_stuff(bus):
    """Known fault of dynamixel-sdk 4.1.0: what it sends is never stuffed, so the servo takes an FD away."""
    if bus.model != "xl430-w250":
        return
    indirect_data = 224
    sent = [0xFF, 0xFF, 0xFD, 0xFD, 0x00, 0x77]
    bus.packets.writeTxRx(bus.port, 2, indirect_data, len(sent), sent)
    kept = [bus.read(2, (indirect_data + at, 1)) for at in range(len(sent))]
    same("xl430-w250: what an unstuffed write leaves", kept, [0xFF, 0xFF, 0xFD, 0x00, 0x77, 0x00])


STEPS = (finds, reads_and_writes, is_refused, does_not_stuff, moves_together, is_configured)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    dialrig, models = sys.argv[1], sys.argv[2:] or list(MODELS)
    with tempfile.TemporaryDirectory() as folder:
        for model in models:
            bus = Bus(dialrig, model, folder)
            try:
                for step in STEPS:
                    step(bus)
            finally:
                bus.close()
            print(f"{model}: found, read, written, refused, moved, configured", flush=True)


if __name__ == "__main__":
    try:
        main()
    except AssertionError as wrong:
        sys.exit(f"makers.py: {wrong}")
