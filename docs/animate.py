#!/usr/bin/env python3
"""One animation of the pictures of a run, for a browser, a talk or a paper's supplement.

    pip install pillow                                                  # for .webp, .png (animated PNG), .gif
    pip install pillow "imageio[ffmpeg]"                                # for .mp4 (H.264) as well
    python3 docs/animate.py results/wheel_rail_fretting layer.webp      # frames/frame_*.png
    python3 docs/animate.py results/wheel_rail_fretting small.webp --width 720
    python3 docs/animate.py results/wheel_rail_fretting chains.mp4 --pictures chains --rate 8

Pictures stand in the order of their steps, each for 1/RATE seconds; .webp and .png keep every pixel. Smaller pictures stand in the middle of a
white page of the size of the largest.
"""
import argparse
import sys
from pathlib import Path

from PIL import Image


def pictures(folder, kind):
    """Files of the pictures of a kind (frame, chains, stress, ...), by step."""
    files = [f for f in Path(folder, "frames").glob(f"{kind}_*.png") if f.stem.removeprefix(f"{kind}_").isdigit()]
    return sorted(files, key=lambda f: int(f.stem.removeprefix(f"{kind}_")))


def frames(files, even, wide):
    """The pictures in one size, `wide` pixels wide if given, with even numbers of pixels where a video needs them."""
    images = [Image.open(f).convert("RGB") for f in files]
    if wide:
        images = [i.resize((wide, round(i.height * wide / i.width)), Image.Resampling.LANCZOS) for i in images]
    width, height = (max(i.size[k] for i in images) for k in (0, 1))
    if even:
        width, height = width + width % 2, height + height % 2
    pages = []
    for image in images:
        page = Image.new("RGB", (width, height), "white")
        page.paste(image, ((width - image.width) // 2, (height - image.height) // 2))
        pages.append(page)
    return pages


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("folder", help="folder of a run")
    words.add_argument("out", type=Path, help="file to write: .webp, .png, .gif or .mp4")
    words.add_argument("--pictures", default="frame", help="first part of their names: frame, bonds, shear, circuit, chains, stress or slip (default: frame)")
    words.add_argument("--rate", type=float, default=4.0, help="pictures a second (default: 4)")
    words.add_argument("--width", type=int, help="width of the pictures in pixels, compressed with small losses (default: as they are, without losses)")
    options = words.parse_args()
    suffix = options.out.suffix.lower()
    if suffix not in (".webp", ".png", ".gif", ".mp4"):
        sys.exit(f"animate: cannot write {options.out}; name a file that ends in .webp, .png, .gif or .mp4")
    if options.width is not None and options.width < 16:
        sys.exit("animate: --width is a number of pixels; give 16 or more")
    if not options.rate > 0:
        sys.exit("animate: --rate is the number of pictures a second; give one above 0")
    files = pictures(options.folder, options.pictures)
    if len(files) < 2:
        sys.exit(f"animate: {options.folder}/frames has {len(files)} pictures {options.pictures}_STEP.png; run the case with `--set output.frames=24`, or name others with --pictures")
    pages = frames(files, even=suffix == ".mp4", wide=options.width)
    if suffix == ".mp4":
        try:
            import imageio.v3 as imageio
            import numpy
        except ImportError:
            sys.exit('animate: .mp4 needs imageio: pip install "imageio[ffmpeg]", or write .webp')
        video = numpy.stack([numpy.asarray(p) for p in pages])
        imageio.imwrite(options.out, video, fps=options.rate, codec="libx264", macro_block_size=2)
    else:
        more = {}
        if suffix == ".webp":
            more = {"quality": 55, "method": 6} if options.width else {"lossless": True}
        pages[0].save(options.out, save_all=True, append_images=pages[1:], duration=round(1000 / options.rate), loop=0, **more)
    print(f"{options.out}: {len(pages)} pictures, {pages[0].width} x {pages[0].height}, {options.out.stat().st_size / 1e6:.2g} MB")


if __name__ == "__main__":
    main()
