#!/usr/bin/env python3
"""The page docs/gallery.md and its pictures, made from the shipped cases.

    pip install pillow
    cargo build --release
    python3 docs/gallery.py            # the page, with the pictures and times that are there
    python3 docs/gallery.py NAME ...   # runs these cases, draws their pictures, and writes the page
    python3 docs/gallery.py --all      # runs all of them: some hours of one core

Title and sentence of a case are those of its file, its question is below. The time is the processor
time of the run, kept in docs/figures/gallery/times.csv with the version of the program.
"""

import csv
import json
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs/figures/gallery"
TIMES = PICTURES / "times.csv"
RUNS = ROOT / "results/gallery"
PROGRAM = os.environ.get("FRETWORK", ROOT / "target/release/fretwork")
WIDTH, COLOURS = 420, 48

# Cases by what they are about: question, and the picture of the run that answers it; the last frame
# where none is named.
GALLERY = {
    "Third bodies": {
        "wheel_rail_fretting": ("How much friction has a layer of oxide between wheel and rail, and how much of it breaks?", ""),
        "fretting_resistance": ("How does the electric resistance of a contact rise while its third body breaks?", "fretting_loops.png"),
        "wheel_rail_powder": ("What does sand, clay or MoS2 between wheel and rail do to friction?", ""),
        "powder_between_steel": ("Does a simulated powder have the friction that was measured between steel?", ""),
        "wheel_rail_degradable": ("What if the rail itself is a source of debris?", ""),
        "third_body_steady": ("When are source and wear flow of a third body equal?", ""),
        "regime_map": ("When does a layer flow in shear, and when does it slide as a plug?", ""),
        "soft_third_body": ("How do softness and cohesion of debris change friction?", ""),
        "wheel_rail_fretting_elastic": ("How much slip remains of a displacement when wheel and rail are elastic?", ""),
        "wheel_rail_rigid": ("What do rigid contacts change?", ""),
    },
    "Wheel on rail": {
        "wheel_rail_rolling": ("What is the adhesion of a wheel that rolls over debris?", ""),
        "wheel_rail_creep": ("What happens to the layer while a point passes the patch of a wheel with creepage?", ""),
        "carter_rolling": ("What force has a rolling line contact at a creepage?", "deformable.png"),
    },
    "Fretting and wear": {
        "cylinder_on_flat_fretting": ("Where does a cylinder that frets on a flat stick, and where does it slip?", ""),
        "sphere_on_flat_fretting": ("Partial or gross slip: where is a ball on a flat?", "fretting_loops.png"),
        "fretting_wear_elastic": ("What scar does gross slip leave, and how does its pressure change?", "scar_flat.png"),
        "fretting_scar": ("What is the shape of the scar below a cylinder?", "scar_flat.png"),
        "punch_scar": ("Why does a punch that rocks wear deeper at its sides?", "scar_flat.png"),
        "fretting_wear_jump": ("How can a thousand cycles of wear be had for the price of a few?", "scar_flat.png"),
    },
    "Heat": {
        "wheel_rail_flash": ("How warm does a third body become at 1 m/s, and what does that do to friction?", ""),
        "surface_temperatures": ("Which of two surfaces becomes warmer, and why?", ""),
        "flash_gouge": ("Where does a fault shear and heat?", ""),
    },
    "Granular flows": {
        "plane_shear": ("How does friction of grains depend on the rate of shear?", ""),
        "cohesive_shear": ("What does attraction between grains do to it?", ""),
        "shear_cell_3d": ("How do spheres move in a shear cell?", ""),
        "silo": ("How fast does a silo empty, and who carries the weight?", ""),
        "silo_3d": ("And in three dimensions?", "frames/frame_00000750.png"),
        "rotating_drum_2d": ("What slope has the surface in a rotating drum?", ""),
        "rotating_drum_3d": ("How do the end walls of a drum change it?", ""),
        "collapse": ("How far does a column spread?", ""),
        "biaxial": ("What strength has a sample of grains in a biaxial test?", ""),
    },
    "Bonded bodies": {
        "voronoi_block": ("Where does a block that is pulled obliquely crack?", ""),
        "voronoi_block_3d": ("And in three dimensions?", ""),
        "fault_propagation": ("How does a fault grow through layers?", ""),
        "forced_fold": ("How do layers drape over a block that rises?", ""),
    },
    "Blocks": {
        "newton_cradle": ("Why do as many balls leave as arrive?", ""),
        "masonry_arch": ("How thin may an arch be?", ""),
        "block_wall": ("At which tilt does a wall slide?", ""),
        "block_tower": ("What do the joints of a tower carry?", ""),
        "painleve_rod": ("Can a sliding rod jam without an impact?", ""),
    },
}


def of_case(name, key):
    """The text of a key at the head of a case."""
    text = (ROOT / f"cases/{name}.ron").read_text(encoding="utf-8")
    found = re.search(rf'^\s*{key}: "(.*?)(?<!\\)",$', text, re.MULTILINE | re.DOTALL)
    return re.sub(r"\s*\\\n\s*", " ", found[1]).replace('\\"', '"') if found else ""


def run(name, picture):
    """Runs a case to its end; returns its processor time (s) and the version of the program."""
    from PIL import Image

    out = RUNS / name
    if not (out / "summary.json").exists():
        subprocess.run([PROGRAM, "run", ROOT / f"cases/{name}.ron", "--out", out, "--resume"], check=True, stdout=subprocess.DEVNULL)
    frames = [*sorted(out.glob("*.png")), *sorted((out / "frames").glob("*.png")), *sorted((out / "frames").glob("frame_*.png"))]
    source = out / picture if picture else frames[-1]
    image = Image.open(source).convert("RGB")
    image.thumbnail((WIDTH, WIDTH))
    image.quantize(COLOURS).save(PICTURES / f"{name}.png", optimize=True)
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return summary["cpu_seconds"], summary["version"]


def minutes(seconds):
    """As one would say it."""
    for least, text in ((0.0, "seconds"), (15.0, "less than one")):
        if seconds < (15.0, 60.0)[least > 0]:
            return text
    return f"{seconds / 60:.0f}"


def read_times():
    """Processor times of the runs, by the name of the case."""
    if not TIMES.exists():
        return {}
    with TIMES.open(encoding="utf-8") as file:
        return {row["case"]: row for row in csv.DictReader(file)}


def page(times):
    lines = [
        "# Gallery",
        "",
        "What the shipped cases answer. Each runs by its name, in any folder; `fretwork cases copy NAME`",
        "copies one to be changed, and the comment at its head says what to vary. Times are of one core.",
        "",
        "The page is made from the cases: `python3 docs/gallery.py`.",
    ]
    for topic, cases in GALLERY.items():
        lines += ["", f"## {topic}"]
        for name, (question, _) in cases.items():
            time = f", {minutes(float(times[name]['seconds']))} minutes" if name in times else ""
            time = time.replace("seconds minutes", "seconds").replace("one minutes", "a minute").replace(", 1 minutes", ", 1 minute")
            lines += ["", f"### {question}", ""]
            if (PICTURES / f"{name}.png").exists():
                lines += [f"![{of_case(name, 'name')}](figures/gallery/{name}.png)", ""]
            lines += [*textwrap.wrap(of_case(name, "doc"), 100), "", f"`fretwork run {name}`{time};", f"[its case](../cases/{name}.ron)"]
    return "\n".join(lines) + "\n"


def main():
    PICTURES.mkdir(parents=True, exist_ok=True)
    times = read_times()
    pictures = {name: picture for cases in GALLERY.values() for name, (_, picture) in cases.items()}
    wanted = list(pictures) if sys.argv[1:] == ["--all"] else sys.argv[1:]
    for name in wanted:
        seconds, version = run(name, pictures[name])
        times[name] = {"case": name, "seconds": f"{seconds:.0f}", "version": version}
        print(name, f"{seconds:.0f} s", flush=True)
        with TIMES.open("w", newline="") as file:
            table = csv.DictWriter(file, ["case", "seconds", "version"], lineterminator="\n")
            table.writeheader()
            table.writerows(times[each] for each in pictures if each in times)
    (ROOT / "docs/gallery.md").write_text(page(times), encoding="utf-8")


if __name__ == "__main__":
    main()
