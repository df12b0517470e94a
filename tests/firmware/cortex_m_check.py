# SPDX-License-Identifier: Apache-2.0
"""The same node on a Cortex-M3 (QEMU) and on the host: cortex_m_check.py BINARY_DIR

A script of ticks, polls and arrivals (firmware/script/script.h) is made against host_node --script, whose frames the
replies in it answer, and then played to the image: every byte that comes back has to be the same.
"""
import functools
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/firmware")]
import datagrams
from run_cases import Skip, case, in_time, run_cases

BINARY = pathlib.Path(sys.argv[1]).resolve()
HOST_NODE = BINARY / "firmware/host_node"
BUILD = BINARY / "firmware/cortex_m"
KEY = bytes(range(16))
NEEDED = ("arm-none-eabi-g++", "arm-none-eabi-nm", "qemu-system-arm", "cmake", "ninja")


def output_of(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{command[0]}: {done.stdout}{done.stderr}"
    return done.stdout


@functools.cache
def image():
    """The image, built; skips where the packages are not there."""
    missing = [tool for tool in NEEDED if not shutil.which(tool)]
    if missing:
        raise Skip(f"needs {missing[0]}: ./dev firmware installs what packages-firmware.txt lists")
    folder = ROOT / "firmware/cortex_m"
    output_of("cmake", "-G", "Ninja", "-S", folder, "-B", BUILD, "--toolchain", folder / "toolchain.cmake")
    output_of("cmake", "--build", BUILD)
    return BUILD / "node.elf"


class Player:
    """A process that plays a script. Reads with a limit of time, since a broken image says nothing."""

    def __init__(self, command, seconds=60):
        self.process = subprocess.Popen([str(c) for c in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL)  # QEMU's words on timers that are off
        self.limit = threading.Timer(seconds, self.process.kill)
        self.limit.start()

    def put(self, kind, fields=b""):
        os.write(self.process.stdin.fileno(), struct.pack(">H", len(fields) + 1) + kind + fields)

    def get(self):
        head = self.process.stdout.read(2)
        # QEMU stands still for good once in some hundred lives, on a busy machine; the same life then passes.
        in_time(len(head) == 2, "the player ended early, or did not answer in time")
        message = self.process.stdout.read(struct.unpack(">H", head)[0])
        return message[:1], message[1:]

    def until(self, last):
        """All messages up to the one of kind `last`."""
        got = []
        while not got or got[-1][0] != last:
            got.append(self.get())
        return got

    def close(self):
        self.limit.cancel()
        self.process.kill()
        self.process.wait()


def host():
    return Player([HOST_NODE, "--script"])


def board():
    return Player(["qemu-system-arm", "-M", "lm3s6965evb", "-display", "none", "-monitor", "none",
                   "-serial", "stdio", "-kernel", image()])


class Scene:
    """A script in the making, played to the host's node as it grows."""

    def __init__(self, seed, key=None, clockless=False, narrow=False, start_us=0):
        self.seed, self.random = seed, random.Random(seed)
        self.key, self.clockless = key, clockless
        self.script, self.got, self.sent = [], [], []
        self.player = host()
        self.now, self.reply_sequence = start_us, 0
        flags = (1 if key else 0) | (2 if clockless else 0) | (4 if narrow else 0)
        self.put(b"C", struct.pack(">2IB16s2I", 7, self.random.getrandbits(32), flags, key or bytes(16), 66_667, 1000))

    def put(self, kind, fields=b""):
        self.script.append((kind, fields))
        self.player.put(kind, fields)
        if kind == b"D":
            return
        news = self.player.until(b"N" if kind == b"E" else b"K")
        self.got += news
        self.sent += [datagrams.opened(fields, self.key) for kind, fields in news if kind == b"S"]

    def tick(self, due=1, present=None):
        values = [self.random.gauss(0, 10) for _ in range(10)]
        if present is None:
            present = self.random.choice([11, 11, 11, 15, 4, 0, 128])
        self.put(b"T", struct.pack(">QIB10f", self.now, due, present, *values))

    def poll(self, flags=3, battery=0):
        self.put(b"P", struct.pack(">QBH", self.now, flags, battery))

    def arrive(self, data):
        self.put(b"D", data)

    def host_answers(self):
        """What an honest host would send for the newest frame."""
        origin = self.sent[-1].origin
        if self.clockless:
            return datagrams.answer(origin, self.random.getrandbits(32), 1, 2, self.key)
        self.reply_sequence += 1
        return datagrams.reply(origin, self.reply_sequence, self.random.getrandbits(32), self.key,
                               self.random.random() < 0.5)

    def something_arrives(self):
        draw = self.random.random()
        data = bytearray(self.host_answers() if self.sent else self.random.randbytes(44))
        if draw < 0.15:
            data[self.random.randrange(len(data))] ^= 1 << self.random.randrange(8)
        elif draw < 0.2:
            data = data[:self.random.randrange(len(data))]
        elif draw < 0.25:
            data += bytes(self.random.randrange(100))
        elif draw < 0.3:
            data = self.random.randbytes(self.random.randrange(70))
        self.arrive(bytes(data))
        if draw > 0.95:
            self.arrive(bytes(data))

    def wander(self, steps):
        """Random life: uneven ticks, missed ones, an unsteady radio, replies, noise."""
        for _ in range(steps):
            self.now += self.random.choice([1, 900, 5_000, 10_000, 10_000, 30_000])
            if self.random.random() < 0.02:
                self.now += 300_000
            if self.random.random() < 0.6:
                self.tick(due=self.random.choice([1, 1, 1, 1, 0, 2, 5]))
            for _ in range(self.random.choice([0, 0, 0, 1, 2, 9 if self.random.random() < 0.05 else 1])):
                self.something_arrives()
            flags = (self.random.random() < 0.95) | (self.random.random() < 0.9) << 1 | (self.random.random() < 0.5) << 2
            self.poll(flags, self.random.randrange(65536))

    def end(self):
        self.put(b"E")
        self.player.close()
        return self


def played_on_board(script):
    """What the image says to a script, and the bytes of its stack that it used."""
    player = board()
    try:
        # all at once, beside the reading: a round trip a message would take a minute
        writer = threading.Thread(target=lambda: [player.put(*message) for message in script], daemon=True)
        writer.start()
        got = player.until(b"N")
        kind, used = player.get()
        assert kind == b"M"
        return got, struct.unpack(">I", used)[0]
    finally:
        player.close()


def fresh_seeds(n):
    given = os.environ.get("KINALIGN_SEED")
    return [int(given)] if given else [random.SystemRandom().getrandbits(32) for _ in range(n)]


def same(scene):
    """Whether the board says what the host said; its stack."""
    got, stack = played_on_board(scene.script)
    for i, (ours, theirs) in enumerate(zip(scene.got, got)):
        assert ours == theirs, f"seed {scene.seed}, message {i}: host {ours}, board {theirs}"
    assert len(got) == len(scene.got), f"seed {scene.seed}"
    return stack


@case
def the_image_holds_neither_heap_nor_exceptions(_):
    names = output_of("arm-none-eabi-nm", "-C", image())
    for word in ("malloc", "free", "sbrk", "operator new", "operator delete", "__cxa_throw", "_Unwind", "printf"):
        assert f" {word}" not in names, word


@case
def the_image_needs_less_than_12_KiB_of_code_and_40_KiB_of_memory(_):
    text, data, bss = map(int, output_of("arm-none-eabi-size", image()).splitlines()[1].split()[:3])
    scene = Scene(1, KEY)
    scene.wander(200)
    stack = same(scene.end())
    print(f"image: .text {text}, .data {data}, .bss {bss}, stack {stack} bytes")
    library = output_of("arm-none-eabi-size", "-t", BUILD / "libnode.a").splitlines()[-1].split()
    print(f"of it node and wire, before unused parts are left out: .text {library[0]}, .data {library[1]}, .bss {library[2]}")
    page = (ROOT / "firmware/README.md").read_text()
    for said in (f"{text:,} bytes of code", f"{bss:,} of static memory", f"{stack} bytes of stack", f"is {int(library[0]):,}"):
        assert said in " ".join(page.split()), f"firmware/README.md: expected {said}"
    assert text + data < 12 * 1024
    assert data + bss + stack < 40 * 1024


@case
def a_node_at_rest_sends_the_same_bytes_on_both(_):
    scene = Scene(2)
    for _ in range(100):
        scene.now += 10_000
        scene.tick(present=11)
        if scene.sent:
            scene.arrive(scene.host_answers())
        scene.poll()
    same(scene.end())
    assert len(scene.sent) == 15
    assert sum(len(frame.samples) for frame in scene.sent) > 90
    assert sum(frame.echo is not None for frame in scene.sent) == 14


@case
def a_long_outage_drops_the_same_samples_on_both(_):
    scene = Scene(3, KEY)
    for i in range(900):
        scene.now += 10_000
        scene.tick(present=15)
        scene.poll(3 if i > 800 else 1 if i > 400 else 0)
    same(scene.end())
    assert max(len(frame.samples) for frame in scene.sent) == 30


@case
def a_counter_past_32_bits_is_the_same_on_both(_):
    for narrow in (False, True):
        scene = Scene(4, narrow=narrow, start_us=2**32 - 500_000)
        for _ in range(100):
            scene.now += 10_000
            scene.tick()
            scene.poll()
        same(scene.end())


@case
def random_lives_are_the_same_on_both(_):
    for seed in fresh_seeds(4):
        scene = Scene(seed, KEY if seed % 2 else None)
        scene.wander(250)
        same(scene.end())


@case
def random_clockless_lives_are_the_same_on_both(_):
    for seed in fresh_seeds(2):
        scene = Scene(seed, KEY, clockless=True)
        scene.wander(200)
        same(scene.end())
        assert any(sent.kind == datagrams.CONFIRM for sent in scene.sent), f"seed {seed}: no confirm"


sys.exit(run_cases("kinalign_cortex_m_"))
