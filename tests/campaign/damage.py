"""Damage of files: flipped bytes; parts cut, doubled, exchanged, or overwritten with numbers, words and escape sequences; and
checksums repaired afterwards, so that the code behind them is reached."""
import re
import struct
import zlib

WORDS = [b"\x1b[31m", b"\x1b]0;x\x07", "\u009b31m".encode(), "\u202e".encode(), "\u2028".encode(), b"\0", b"\\u0000", b"\\u001b[2J",
         b"\xff", b"\xc3", b"1e999", b"-1", b"0", b"1e-320", b"9223372036854775808", b"-9223372036854775808", b"4294967295",
         b"16777216", b"null", b"true", b"[]", b"{}", b"\"\"", b"[[[[[[[[", b"{\"a\":" * 70, b"../../x", b"/dev/null", b"-",
         b"%d%s%n", b"a" * 5000, b"nan", b"inf", b",", b":", b"\"", b"\n", b"//", b"/*", b"impact:1", b"impact:99999999999", b"file:///x"]
NUMBERS = [0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff]
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?")


def mutate(data, dice, is_text):
    data = bytearray(data)
    for _ in range(dice.choice([1, 1, 1, 2, 3, 8])):
        at = dice.randrange(len(data) + 1)
        kind = dice.choice(["flip", "byte", "cut", "drop", "double", "swap", "word", "word", "number"] + ["value", "word"] * (2 * is_text))
        if kind == "flip" and at < len(data):
            data[at] ^= 1 << dice.randrange(8)
        elif kind == "byte" and at < len(data):
            data[at] = dice.randrange(256)
        elif kind == "cut":
            del data[at:]
        elif kind == "drop":
            del data[at:at + dice.choice([1, 2, 4, 16, 256])]
        elif kind == "double":
            data[at:at] = data[at:at + dice.choice([1, 8, 64, 1024])]
        elif kind == "swap" and len(data) > 64:
            a, n = dice.randrange(len(data) - 32), dice.randrange(1, 32)
            at = min(at, len(data) - n)
            data[a:a + n], data[at:at + n] = data[at:at + n], data[a:a + n]
        elif kind == "word":
            data[at:at + dice.choice([0, 0, 1, 8])] = dice.choice(WORDS)
        elif kind == "number" and not is_text:
            size, order = dice.choice([1, 2, 4, 8]), dice.choice(["little", "big"])
            data[at:at + size] = (dice.choice(NUMBERS) & ((1 << 8 * size) - 1)).to_bytes(size, order)
        elif kind == "value":
            found = list(NUMBER.finditer(data))
            if found:
                one = dice.choice(found)
                data[one.start():one.end()] = dice.choice(WORDS)
    return bytes(data)


def repair_png(data):
    """Gives every chunk its checksum; stops where the lengths make no sense."""
    out, at = bytearray(data[:8]), 8
    while at + 12 <= len(data):
        size = struct.unpack(">I", data[at:at + 4])[0]
        if at + 12 + size > len(data):
            break
        body = data[at + 4:at + 8 + size]
        out += data[at:at + 4] + body + struct.pack(">I", zlib.crc32(body))
        at += 12 + size
    return bytes(out + data[at:])


def repair_npz(data):
    """Writes the checksums of stored arrays into the directory."""
    data, at = bytearray(data), 0
    while (at := data.find(b"PK\1\2", at)) >= 0 and at + 46 <= len(data):
        method, = struct.unpack_from("<H", data, at + 10)
        size, = struct.unpack_from("<I", data, at + 20)
        offset, = struct.unpack_from("<I", data, at + 42)
        if offset + 30 <= len(data):
            begin = offset + 30 + sum(struct.unpack_from("<HH", data, offset + 26))
            if method == 0 and begin + size <= len(data):
                struct.pack_into("<I", data, at + 16, zlib.crc32(data[begin:begin + size]))
        at += 46
    return bytes(data)
