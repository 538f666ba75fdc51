#!/usr/bin/env python3
"""Steps of rays by bounds cell by cell beside those by one bound a shape: a table in Markdown.

    bench/steep.py [--size WxH] [--seconds N] PROGRAM [SCENE …]

PROGRAM is a built `fathom`. Without scenes: all examples, and the scenes of bench/steep, whose bounds
are large. A row says, before and after: undecided rays, steps of a mean ray and of all but one in a
hundred, evaluations a pixel, and the time of a frame by the processor and its ratio. What takes
longer than N seconds is left out, and named at the end.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def measured(program, scene, size, seconds, one_bound):
    words = [program, "bench", str(scene), "--json", "--size", size]
    done = subprocess.run(
        words + (["--one-bound"] if one_bound else []),
        capture_output=True,
        text=True,
        timeout=seconds,
        check=True,
    )
    return {row["name"]: row["value"] for row in json.loads(done.stdout)["rows"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    scenes = options.scenes or [
        *sorted((ROOT / "examples").glob("*.sdf")),
        *sorted((ROOT / "bench" / "steep").glob("*.sdf")),
    ]
    print("| scene | undecided | mean steps | 99 of 100 | evaluations | frame, ms | ratio |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    missing = []
    for scene in scenes:
        try:
            before, after = (
                measured(options.program, scene, options.size, options.seconds, one)
                for one in (True, False)
            )
        except (subprocess.TimeoutExpired, subprocess.CalledProcessError) as error:
            missing.append(f"{scene.stem}: {type(error).__name__}")
            continue
        cells = [scene.stem]
        for name in (
            "undecided rays",
            "steps a ray",
            "steps, 99 of 100 rays",
            "evaluations a pixel",
            "CPU frame",
        ):
            cells.append(f"{before[name]:.3g} → {after[name]:.3g}")
        cells.append(f"{after['CPU frame'] / before['CPU frame']:.2f}")
        print("| " + " | ".join(cells) + " |", flush=True)
    for line in missing:
        print(f"not measured: {line}", file=sys.stderr)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
