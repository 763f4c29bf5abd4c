#!/usr/bin/env python3
"""The pictures of docs/paraview.md: grains, contacts and a deformable body of short runs, drawn with pyvista from the .vtkhdf files.

    pip install pyvista pillow
    cargo build --release
    python3 docs/paraview_pictures.py [FOLDER]          # runs five cases into results/paraview, some two minutes, and writes PNG files there
    python3 docs/paraview_pictures.py --figures         # writes them to docs/figures

Without a screen on Linux, VTK 9.4 or newer renders in memory; older ones need `xvfb-run python3 docs/paraview_pictures.py`.
"""
import argparse
import os
import subprocess

import numpy as np
import pyvista
from PIL import Image

PROGRAM = os.environ.get("FRETWORK", "target/release/fretwork")
CASES = {
    "spheres": ["cases/shear_cell_3d.ron"],
    "disks": ["cases/plane_shear.ron", "--set", "time.end=1.2"],
    "plate": ["cases/verification/voronoi_plate.ron", "--set", "output.views=8"],
    "layer": ["cases/fretting_resistance.ron", "--set", "time.end=0.075", "--set", "output.views=3"],
    "cylinder": ["cases/cylinder_on_flat_fretting.ron", "--set", "time.end=0.0225", "--set", "output.views=9"],
}
# By status: 0 no force, 1 stick, 2 slip, 3 intact bond, 4 broken bond without force.
STATUS = {0: ("no force", "#bbbbbb"), 1: ("stick", "#0072b2"), 2: ("slip", "#e69f00"), 3: ("intact bond", "#cc3311"), 4: ("broken bond", "#66ccee")}
SIZE = (1000, 640)
LARGEST = 140_000  # bytes of a picture; fewer colours where it has more


def states(path):
    """Time and data set of each state of a .vtkhdf file."""
    reader = pyvista.get_reader(path)
    for step in range(reader.reader.GetNumberOfSteps()):
        reader.reader.SetStep(step)
        data = reader.read()
        yield reader.reader.GetTimeValue(), data


def last(path):
    """Time and data set of the last state."""
    return list(states(path))[-1]


def scene(smooth=True):
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("white")
    if smooth:
        plotter.enable_anti_aliasing("ssaa")
    return plotter


def bar(title):
    return {"title": title, "color": "black", "vertical": True, "position_x": 0.86, "position_y": 0.2, "height": 0.6, "title_font_size": 20, "label_font_size": 18, "fmt": "%.3g"}


def flat_view(plotter, low, high):
    """Looks along -z at the rectangle between two corners."""
    centre = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0]
    plotter.camera_position = [[centre[0], centre[1], 1.0], centre, [0, 1, 0]]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = max((high[1] - low[1]) / 2, (high[0] - low[0]) / 2 * SIZE[1] / SIZE[0]) * 1.05
    plotter.reset_camera_clipping_range()


def grains(run):
    """Spheres of the grains' radii, coloured by speed."""
    time, points = last(f"{run}/grains.vtkhdf")
    points = points.extract_points(points["first_body"] == 0, include_cells=False)
    points["speed"] = np.linalg.norm(points["velocity"], axis=1)
    ball = pyvista.Sphere(radius=1.0, theta_resolution=20, phi_resolution=20)
    plotter = scene()
    balls = points.glyph(geom=ball, scale="radius", orient=False)
    plotter.add_mesh(balls, scalars="speed", cmap="viridis", clim=(0.0, 0.1), smooth_shading=True, scalar_bar_args=bar("speed (m/s)"))
    plotter.add_text(f"t = {time:.3g} s", color="black", font_size=11)
    plotter.view_vector((-0.55, -1.0, 0.45), (0, 0, 1))
    plotter.camera.zoom(1.2)
    return plotter


def contacts(run):
    """Contacts coloured by status with arrows of their forces on body_1, over disks of the grains' radii."""
    time, lines = last(f"{run}/contacts.vtkhdf")
    points = last(f"{run}/grains.vtkhdf")[1]
    plotter = scene(smooth=False)  # smooth edges of lines need more colours than a small picture has
    disk = pyvista.Disc(inner=0.0, outer=1.0, c_res=36).translate((0.0, 0.0, -0.1))
    plotter.add_mesh(points.glyph(geom=disk, scale="radius", orient=False), color="#eeeeee", lighting=False)
    for status, (name, colour) in STATUS.items():
        chosen = lines.extract_cells(lines["status"] == status)
        if chosen.n_cells:
            plotter.add_mesh(chosen, color=colour, line_width=4, lighting=False, label=name)
    centres = lines.cell_centers()
    centres["size"] = np.linalg.norm(centres["force"], axis=1)
    largest = centres["size"].max()
    loaded = centres.extract_points(centres["size"] > 0.03 * largest, include_cells=False)
    arrow = pyvista.Arrow(tip_length=0.25, tip_radius=0.06, shaft_radius=0.02)
    arrows = loaded.glyph(geom=arrow, orient="force", scale="size", factor=0.03 / largest)
    plotter.add_mesh(arrows, color="black", lighting=False, label="force on body_1")
    plotter.add_legend(bcolor="white", border=False, face="rectangle", size=(0.2, 0.22), loc="upper right")
    plotter.add_text(f"t = {time:.3g} s", color="black", font_size=11)
    flat_view(plotter, (0.0, 0.0), (0.2, 0.1))
    return plotter


def shapes(run):
    """Cells of a plate by their speed."""
    time, cells = last(f"{run}/shapes.vtkhdf")
    cells["speed"] = np.linalg.norm(cells["velocity"], axis=1)
    plotter = scene()
    plotter.add_mesh(cells, scalars="speed", cmap="viridis", show_edges=True, lighting=False, scalar_bar_args=bar("speed (m/s)"))
    plotter.add_text(f"t = {time:.3g} s", color="black", font_size=11)
    flat_view(plotter, (-0.11, -0.03), (0.54, 0.23))
    return plotter


def layer(run):
    """Grains of a third body by the damage of their bonds, and the surfaces of the first bodies."""
    time, cells = last(f"{run}/shapes.vtkhdf")
    surfaces = last(f"{run}/bodies.vtkhdf")[1]
    plotter = scene()
    plotter.add_mesh(cells, scalars="damage", cmap="inferno_r", clim=(0.0, 1.0), nan_color="#dddddd", lighting=False, scalar_bar_args=bar("damage"))
    plotter.add_mesh(surfaces, color="black", line_width=2, lighting=False)
    plotter.add_text(f"t = {time:.3g} s", color="black", font_size=11)
    low, high = np.array(cells.bounds[0::2]), np.array(cells.bounds[1::2])
    flat_view(plotter, low, (high[0] + 0.25 * (high[0] - low[0]), high[1]))
    return plotter


def mesh(run):
    """Von Mises stress of two bodies of finite elements, displacements magnified."""
    factor, plotter = 100.0, scene()
    for name in ("flat", "cylinder"):
        time, grid = last(f"{run}/mesh_{name}.vtkhdf")
        centres = grid.cell_centers().points
        grid = grid.extract_cells((abs(centres[:, 0]) < 2.4e-3) & (abs(centres[:, 1]) < 1.6e-3))
        grid["stress in MPa"] = grid["von_mises"] / 1e6
        warped = grid.warp_by_vector("displacement", factor=factor)
        plotter.add_mesh(warped, scalars="stress in MPa", cmap="viridis", clim=(0, 75), lighting=False, scalar_bar_args=bar("von Mises (MPa)"))
    plotter.add_text(f"t = {time:.3g} s, displacements times {factor:.0f}", color="black", font_size=11)
    low, high = np.array(plotter.bounds[0::2]), np.array(plotter.bounds[1::2])
    flat_view(plotter, low, (high[0] + 0.25 * (high[0] - low[0]), high[1]))
    return plotter


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("folder", nargs="?", default="results/paraview", help="of the runs and pictures")
    words.add_argument("--figures", action="store_true", help="write the pictures to docs/figures")
    options = words.parse_args()
    for name, case in CASES.items():
        out = os.path.join(options.folder, name)
        if not os.path.exists(os.path.join(out, "summary.json")):
            subprocess.run([PROGRAM, "run", *case, "--out", out, "--force"], check=True, stdout=subprocess.DEVNULL)
    for picture, run in ((grains, "spheres"), (contacts, "disks"), (shapes, "plate"), (layer, "layer"), (mesh, "cylinder")):
        path = os.path.join("docs/figures" if options.figures else options.folder, f"paraview_{picture.__name__}.png")
        plotter = picture(os.path.join(options.folder, run))
        image = Image.fromarray(plotter.screenshot(return_img=True))
        for colours in (256, 128, 64, 32):
            image.quantize(colours).save(path, optimize=True)
            if os.path.getsize(path) < LARGEST:
                break
        plotter.close()
        print(path)


if __name__ == "__main__":
    main()
