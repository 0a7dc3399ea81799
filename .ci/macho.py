#!/usr/bin/env python3
"""Reads a Mach-O file as macOS loads it.

    macho.py FILE PROCESSOR MINIMUM [INSTALL NAME]   checks one processor's part (arm64, x86_64): the least macOS that it
                                                     loads on, its install name, what it needs, and its signature, every
                                                     page of which is hashed again; arm64 must have one
    macho.py FILE PROCESSOR needs | exports          prints libraries that it loads, or symbols that it exports
    macho.py FILE PROCESSOR keep PREFIX              hides all symbols but those of this prefix, in a file for one processor,
                                                     and signs it anew: zig's linker exports all that Rust has. Files that
                                                     debug information was in are named no more, with an empty prefix too
    macho.py OUT ARM64 X86_64 join                   puts two files for one processor each into one, archives too
"""
import hashlib
import struct
import sys

CPU = {"arm64": 0x0100000C, "x86_64": 0x01000007}
N_SO, N_OSO, N_SOL = 0x64, 0x66, 0x84
LC_SYMTAB, LC_LOAD_DYLIB, LC_ID_DYLIB, LC_CODE_SIGNATURE, LC_DYLD_INFO, LC_MIN_MACOS, LC_BUILD, LC_TRIE = 0x2, 0xC, 0xD, 0x1D, 0x22, 0x24, 0x32, 0x33


def part_of(data, processor):
    """The bytes for one processor, of a file for several or for one."""
    if struct.unpack_from(">I", data)[0] != 0xCAFEBABE:
        return data
    for index in range(struct.unpack_from(">I", data, 4)[0]):
        cpu, _, offset, size, align = struct.unpack_from(">5I", data, 8 + 20 * index)
        if cpu == CPU[processor]:
            assert offset % (1 << align) == 0 and align >= 12, f"its part begins at {offset}, off a page"
            return data[offset : offset + size]
    raise AssertionError(f"there is no {processor} in the file")


def commands(data, processor):
    """(command, its bytes) of one processor's part."""
    magic, cpu, _, _, count = struct.unpack_from("<5I", data)
    assert magic == 0xFEEDFACF and cpu == CPU[processor], "it is no 64-bit file for that processor"
    at = 32
    for _ in range(count):
        command, size = struct.unpack_from("<2I", data, at)
        yield command & 0xFFFF, data[at : at + size]
        at += size


def text(command):
    start = struct.unpack_from("<I", command, 8)[0]
    return command[start:].split(b"\0")[0].decode()


def version(command, at):
    number = struct.unpack_from("<I", command, at)[0]
    return f"{number >> 16}.{number >> 8 & 255}"


def exports(trie, at=0, prefix=""):
    """The symbols of an export trie, each with its flags and address as they are written: node by node, each of which has
    these and its edges."""

    def uleb(at):
        value, shift = 0, 0
        while True:
            value |= (trie[at] & 127) << shift
            at, shift = at + 1, shift + 7
            if trie[at - 1] < 128:
                return value, at

    size, at = uleb(at)
    if size:
        yield prefix.removeprefix("_"), trie[at : at + size]
    at += size
    count, at = trie[at], at + 1
    for _ in range(count):
        end = trie.index(0, at)
        child, after = uleb(end + 1)
        yield from exports(trie, child, prefix + trie[at:end].decode())
        at = after


def trie_of(symbols):
    """An export trie of these symbols, all of them edges of its root."""
    wide = lambda number: bytes([number & 127 | 128, number >> 7 & 127 | 128, number >> 14])
    names = [b"_" + name.encode() + b"\0" for name, _ in symbols]
    at = 2 + sum(len(name) + 3 for name in names)
    root, nodes = bytes([0, len(symbols)]), b""
    for name, (_, terminal) in zip(names, symbols):
        root += name + wide(at + len(nodes))
        nodes += bytes([len(terminal)]) + terminal + b"\0"
    return root + nodes


def keep(path, data, processor, prefix):
    """Writes the file anew with the symbols of this prefix alone, in as many bytes."""
    data, signature = bytearray(data), None
    for command, body in commands(data, processor):
        if command == LC_CODE_SIGNATURE:
            signature = struct.unpack_from("<2I", body, 8)
        elif command == LC_SYMTAB:
            symbols, count, names, _ = struct.unpack_from("<4I", body, 8)
            for index in range(count):
                name, kind = struct.unpack_from("<IB", data, symbols + 16 * index)
                if kind in (N_SO, N_OSO, N_SOL):
                    start = names + name
                    end = data.index(0, start)
                    data[start:end] = bytes(end - start)
        elif prefix and command in (LC_TRIE, LC_DYLD_INFO):
            at, size = struct.unpack_from("<2I", body, 8 if command == LC_TRIE else 40)
            kept = [symbol for symbol in exports(bytes(data[at : at + size])) if symbol[0].startswith(prefix)]
            data[at : at + size] = trie_of(kept).ljust(size, b"\0")
    if signature:
        signed_pages(data, *signature, anew=True)
    open(path, "wb").write(data)


def signed_pages(data, offset, size, anew=False):
    """How many pages are signed; each has the hash that the code directory says, or is given it `anew`."""
    signature = data[offset : offset + size]
    magic, _, count = struct.unpack_from(">3I", signature)
    assert magic == 0xFADE0CC0, "its signature is none"
    places = [struct.unpack_from(">2I", signature, 12 + 8 * blob) for blob in range(count)]
    first = next(at for kind, at in places if kind == 0)
    directory = signature[first:]
    hashes, _, _, slots, limit = struct.unpack_from(">5I", directory, 16)
    hash_size, hash_type, _, shift = directory[36:40]
    page = 1 << shift
    assert hash_type == 2 and limit == offset, f"{limit} bytes of {offset} before its signature are signed"
    assert slots == -(-limit // page), f"{slots} pages of {-(-limit // page)} are signed"
    for slot in range(slots):
        found = hashlib.sha256(data[slot * page : min((slot + 1) * page, limit)]).digest()
        start = hashes + slot * hash_size
        if anew:
            at = offset + first + start
            data[at : at + hash_size] = found
            continue
        assert directory[start : start + hash_size] == found, f"page {slot} was changed after it was signed"
    return slots


def join(path, *files):
    """A file for both processors: a header, and each file at a page of its own."""
    out = bytearray(struct.pack(">2I", 0xCAFEBABE, len(files)).ljust(1 << 14, b"\0"))
    for index, (processor, file) in enumerate(zip(("arm64", "x86_64"), files)):
        data = open(file, "rb").read()
        subtype = 0 if processor == "arm64" else 3
        struct.pack_into(">5I", out, 8 + 20 * index, CPU[processor], subtype, len(out), len(data), 14)
        out += data.ljust((len(data) + (1 << 14) - 1) >> 14 << 14, b"\0")
    open(path, "wb").write(out)


def main():
    if sys.argv[-1] == "join":
        return join(*sys.argv[1:-1])
    path, processor, minimum, *names = sys.argv[1:]
    data = part_of(open(path, "rb").read(), processor)
    if minimum == "keep":
        return keep(path, data, processor, *names)
    own_name, needs, least, pages, trie = None, [], None, 0, b""
    for command, body in commands(data, processor):
        if command == LC_ID_DYLIB:
            own_name = text(body)
        elif command == LC_LOAD_DYLIB:
            needs.append(text(body))
        elif command == LC_BUILD:
            least = version(body, 12)
        elif command == LC_MIN_MACOS:
            least = version(body, 8)
        elif command == LC_CODE_SIGNATURE:
            pages = signed_pages(data, *struct.unpack_from("<2I", body, 8))
        elif command in (LC_TRIE, LC_DYLD_INFO):
            at, size = struct.unpack_from("<2I", body, 8 if command == LC_TRIE else 40)
            trie = data[at : at + size] or trie
    if minimum in ("needs", "exports"):
        return print(*(needs if minimum == "needs" else sorted(name for name, _ in exports(trie))), sep=" " if minimum == "needs" else "\n")
    assert names in ([], [own_name]), f"its install name is {own_name}"
    assert least == minimum, f"it loads on macOS {least}"
    assert pages or processor == "x86_64", "it is not signed, and would not be loaded"
    assert all(name.startswith(("/usr/lib/", "/System/")) for name in needs), f"it needs {needs}"
    print(f"{processor}: macOS {least}, {pages} signed pages, needs {' '.join(needs)}")


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(f"{sys.argv[1]}: {error}")
