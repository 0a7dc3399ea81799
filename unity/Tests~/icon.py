#!/usr/bin/env python3
"""Draws the icon of the package's components, assets and windows: a small figure with a big head.

icon.py [FILE.png]   default Editor/Icons/SuperDeform.png of the package; 128 x 128 pixels, clear around the figure

Shapes lie on top of one another, each with an outline, and are averaged from 4 x 4 points a pixel. The same script writes the
same pixels.
"""

import struct
import sys
import zlib
from pathlib import Path

SIZE, POINTS, OUTLINE = 128, 4, 3.5
SKIN, HAIR, SUIT, DARK, BLUSH = (255, 214, 186), (120, 86, 214), (74, 163, 223), (44, 40, 62), (246, 150, 150)


def round_box(x, y, middle, half, radius):
    """How far a point lies outside of a box with round corners; below 0 within."""
    across, along = abs(x - middle[0]) - half[0] + radius, abs(y - middle[1]) - half[1] + radius
    return (max(across, 0) ** 2 + max(along, 0) ** 2) ** 0.5 + min(max(across, along), 0) - radius


def oval(x, y, middle, half):
    across, along = (x - middle[0]) / half[0], (y - middle[1]) / half[1]
    return ((across * across + along * along) ** 0.5 - 1) * min(half)


def figure():
    """From back to front: (how far outside, colour, whether it has an outline)."""
    for side in (-1, 1):
        yield lambda x, y, s=side: round_box(x, y, (64 + 11 * s, 111), (8, 13), 7), SKIN, True
        yield lambda x, y, s=side: round_box(x, y, (64 + 24 * s, 93), (8, 12), 7), SKIN, True
    yield lambda x, y: round_box(x, y, (64, 96), (19, 19), 9), SUIT, True
    yield lambda x, y: oval(x, y, (64, 44), (50, 42)), SKIN, True
    # The hair: the head without the face, which is parted by a lock.
    yield lambda x, y: max(oval(x, y, (64, 44), (50, 42)), -min(oval(x, y, (64 + 19 * s, 66), (25, 34)) for s in (-1, 1))), HAIR, True
    for side in (-1, 1):
        yield lambda x, y, s=side: oval(x, y, (64 + 19 * s, 57), (7.5, 11)), DARK, False
        yield lambda x, y, s=side: oval(x, y, (67 + 19 * s, 52), (2.6, 3.6)), (255, 255, 255), False
        yield lambda x, y, s=side: oval(x, y, (64 + 31 * s, 70), (6, 3.6)), BLUSH, False
    # The mouth: the lower half of a ring.
    yield lambda x, y: max(abs(oval(x, y, (64, 68), (7, 6))) - 1.6, 68 - y), DARK, False


def colour(x, y, shapes):
    seen = None
    for outside, fill, outlined in shapes:
        far = outside(x, y)
        if far <= 0:
            seen = DARK if outlined and far > -OUTLINE else fill
    return seen


def pixels():
    shapes = list(figure())
    for row in range(SIZE):
        yield 0
        for column in range(SIZE):
            hits = [colour(column + (i + 0.5) / POINTS, row + (j + 0.5) / POINTS, shapes) for i in range(POINTS) for j in range(POINTS)]
            hits = [hit for hit in hits if hit]
            yield from (round(sum(hit[part] for hit in hits) / len(hits)) if hits else 0 for part in range(3))
            yield round(255 * len(hits) / POINTS ** 2)


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def main():
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent / "Editor/Icons/SuperDeform.png"
    head = struct.pack(">IIBBBBB", SIZE, SIZE, 8, 6, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(pixels()), 9)) + chunk(b"IEND", b""))
    print(f"{file}: {file.stat().st_size} bytes")


if __name__ == "__main__":
    main()
