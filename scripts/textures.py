#!/usr/bin/env python3
"""Makes the images and the grid of examples/parts anew: the textures of the gallery and of the library's examples."""
import math
import os
import random
import struct
import zlib

OUT = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples", "parts")


def write_png(name, width, height, pixel):
    """pixel(x, y) gives a gray byte or three; rows run downward."""
    rows, channels = [], 1
    for y in range(height):
        row = bytearray([0])
        for x in range(width):
            value = pixel(x, y)
            value = value if isinstance(value, tuple) else (value,)
            channels = len(value)
            row += bytes(max(0, min(255, round(v))) for v in value)
        rows.append(bytes(row))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 0, 0, 0, 0)
    with open(os.path.join(OUT, name), "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


def scattered(count, size, seed, apart):
    """Points on a torus of the given size, none nearer to another than `apart`."""
    numbers, points = random.Random(seed), []
    while len(points) < count:
        p = (numbers.random() * size, numbers.random() * size)
        if all(wrapped(p, q, size) > apart for q in points):
            points.append(p)
    return points


def wrapped(p, q, size):
    d = [min(abs(a - b), size - abs(a - b)) for a, b in zip(p, q)]
    return math.hypot(*d)


def pebbles(size=128):
    """Round stones side by side, as heights."""
    points = scattered(46, size, 3, 13)

    def pixel(x, y):
        near = sorted(wrapped((x, y), p, size) for p in points)
        gap = (near[1] - near[0]) / 14  # 0 between two stones
        return 255 * math.sqrt(min(1, gap))

    write_png("pebbles.png", size, size, pixel)


def tiles(size=128):
    """A wall of blue and white tiles with a star on each second one."""
    def pixel(x, y):
        u, v = x % 64 - 31.5, y % 64 - 31.5
        if max(abs(u), abs(v)) > 30:
            return (196, 190, 178)  # the joint
        star = max(max(abs(u), abs(v)), (abs(u) + abs(v)) * 0.7071)
        ring = min(max(abs(u), abs(v)), (abs(u) + abs(v)) * 0.7071)
        if (x // 64 + y // 64) % 2 == 0:
            return (36, 84, 148) if ring < 17 else (232, 228, 214) if ring < 20 else (92, 148, 190) if star < 29 else (232, 228, 214)
        return (232, 228, 214) if ring < 12 else (184, 72, 48) if ring < 16 else (238, 233, 220)

    write_png("tiles.png", size, size, pixel)


def rock(n=24):
    """A lump: the distance to a rounded box whose corners are worn by a few balls, on a lattice."""
    numbers = random.Random(5)
    worn = [([numbers.uniform(-1, 1) for _ in range(3)], numbers.uniform(0.25, 0.45)) for _ in range(9)]
    spacing = 2.4 / (n - 1)
    values = []
    for k in range(n):
        for j in range(n):
            for i in range(n):
                p = [-1.2 + spacing * c for c in (i, j, k)]
                q = [abs(c) - h for c, h in zip(p, (0.55, 0.4, 0.5))]
                d = math.sqrt(sum(max(c, 0) ** 2 for c in q)) + min(max(q), 0) - 0.25
                for way, size in worn:
                    length = math.sqrt(sum(c * c for c in way))
                    centre = [c / length * 1.0 for c in way]
                    d = max(d, size - math.dist(p, centre))
                values.append(d)
    header = f"NRRD0004\ntype: float\ndimension: 3\nsizes: {n} {n} {n}\nspacings: {spacing:.6f} {spacing:.6f} {spacing:.6f}\nencoding: raw\nendian: little\n\n"
    with open(os.path.join(OUT, "rock.nrrd"), "wb") as out:
        out.write(header.encode() + struct.pack(f"<{len(values)}f", *values))


if __name__ == "__main__":
    pebbles()
    tiles()
    rock()
