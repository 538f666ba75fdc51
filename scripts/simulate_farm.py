#!/usr/bin/env python3
"""What a farm costs beyond perfect splitting: scripts/simulate_farm.py [--cores N] …

Simulates units of work on many cores: they start one after the other as the engine hands them out, some
machines are slower, some workers are killed and their unit begins again (with --skip-existing: after
its last whole frame), some units straggle. Prints the overhead: the time of the whole beside that of
the same work split perfectly over the same cores. All times in seconds; the random numbers are the
same in every run.
"""
import argparse
import heapq
import random


def simulate(cores, frames, frame_seconds, chunk, start, rate, failures, stragglers, slow, seed):
    """The makespan over the perfect one, and the share of frames that are made twice."""
    chance = random.Random(seed)
    speeds = [1 / chance.uniform(1, slow) for _ in range(cores)]
    free = [(0.0, core) for core in range(cores)]
    heapq.heapify(free)
    units = [min(chunk, frames - first) for first in range(0, frames, chunk)]
    handed, end, again, work = 0.0, 0.0, 0, 0.0
    while units:
        size = units.pop()
        when, core = heapq.heappop(free)
        handed = max(handed + 1 / rate, when)  # the engine starts so many units a second at most
        each = frame_seconds / speeds[core]
        if chance.random() < stragglers:
            each *= 3
        seconds = start + size * each
        # failures are spread evenly over a core's hours
        fails_after = chance.expovariate(failures / 3600) if failures > 0 else seconds + 1
        if fails_after < seconds:
            whole = max(0, int((fails_after - start) / each))
            again += 1  # the frame that it was at
            if size > whole:
                units.append(size - whole)
            seconds = fails_after
        work += seconds
        end = max(end, handed + seconds)
        heapq.heappush(free, (handed + seconds, core))
    perfect = frames * frame_seconds / sum(speeds)
    return end / perfect - 1, again / frames


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cores", type=int, default=10000)
    parser.add_argument("--frames", type=int, default=100000)
    parser.add_argument("--seconds", type=float, default=600, help="of a frame, on one core")
    parser.add_argument("--chunk", type=int, default=1)
    parser.add_argument("--start", type=float, default=0.5, help="of a unit: process, scene, proof")
    parser.add_argument("--rate", type=float, default=100, help="units that the engine starts in a second")
    parser.add_argument("--failures", type=float, default=0.01, help="of a core, in an hour")
    parser.add_argument("--stragglers", type=float, default=0.001, help="share of units, three times as slow")
    parser.add_argument("--slow", type=float, default=1.2, help="the slowest machine's time over the fastest's")
    parser.add_argument("--runs", type=int, default=3)
    o = parser.parse_args()
    over, again = zip(*(simulate(o.cores, o.frames, o.seconds, o.chunk, o.start, o.rate, o.failures,
                                 o.stragglers, o.slow, seed) for seed in range(o.runs)))
    perfect = o.frames * o.seconds / o.cores
    print(f"{o.frames} frames of {o.seconds:g} s on {o.cores} cores, {o.chunk} a unit: "
          f"{perfect / 3600:.2f} h split perfectly; overhead {100 * min(over):.1f} to {100 * max(over):.1f} %, "
          f"{100 * max(again):.2f} % of the frames made again")


if __name__ == "__main__":
    main()
