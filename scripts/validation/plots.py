# SPDX-License-Identifier: BSD-3-Clause
"""One style for all plots: small SVG files whose text stays text, and pictures of the flow as small PNG files."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

COLOURS = ["#4c78a8", "#f58518", "#54a24b", "#b279a2"]  # coarse to fine
REFERENCE = "#333333"
WATER, GAS, SOLID = "#2f6fb0", "#d9c9b0", "#8c8c94"
POINTS = 320  # of a curve
LARGEST, LARGEST_PICTURE = 60000, 180000  # bytes of a plot, of a picture

plt.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "libmps", "font.family": ["DejaVu Sans"], "font.size": 9,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#e4e4e4", "grid.linewidth": 0.6, "axes.linewidth": 0.7,
    "axes.titlesize": 9, "axes.titlelocation": "left", "lines.linewidth": 0.9, "legend.frameon": False, "legend.fontsize": 8,
    "path.simplify_threshold": 0.5})


def thin(t, y, points=POINTS):
    """At most `points` points; of every interval the smallest and the largest, so that peaks stay."""
    use = np.isfinite(y)
    t, y = np.asarray(t)[use], np.asarray(y)[use]
    if len(t) <= points:
        return t, y
    keep = set()
    for part in np.array_split(np.arange(len(t)), points // 2):
        keep |= {part[int(np.argmin(y[part]))], part[int(np.argmax(y[part]))]}
    keep = np.array(sorted(keep | {0, len(t) - 1}))
    return t[keep], y[keep]


class Panel:
    """One pair of axes: curves, marks and a band."""

    def __init__(self, title, y_label, x_label="t [s]", y_limits=None, logarithmic=False):
        self.title, self.y_label, self.x_label, self.y_limits, self.logarithmic = title, y_label, x_label, y_limits, logarithmic
        self.items = []

    def curve(self, label, t, y, colour=None, dashed=False):
        self.items.append(("curve", label, t, y, colour, dashed))
        return self

    def reference(self, label, t, y):
        return self.curve(label, t, y, REFERENCE, True)

    def marks(self, label, t, y, symbol="o"):
        self.items.append(("marks", label, t, y, REFERENCE, symbol))
        return self

    def band(self, label, t, low, high):
        self.items.append(("band", label, t, (low, high), "#bbbbbb", False))
        return self

    def draw(self, axes, points):
        number = 0
        for kind, label, t, y, colour, style in self.items:
            if kind == "curve":
                if colour is None:
                    colour, number = COLOURS[number % len(COLOURS)], number + 1
                axes.plot(*thin(t, y, points), color=colour, linestyle=(0, (4, 2)) if style else "-", label=label)
            elif kind == "marks":
                axes.plot(t, y, style, color=colour, markersize=4, markerfacecolor="none", label=label)
            else:
                pick = np.linspace(0, len(t) - 1, min(len(t), points)).astype(int)
                axes.fill_between(t[pick], y[0][pick], y[1][pick], color=colour, alpha=0.45, linewidth=0, label=label)
        axes.set_title(self.title)
        axes.set_ylabel(self.y_label)
        axes.set_xlabel(self.x_label)
        if self.logarithmic:
            axes.set_yscale("log")
        if self.y_limits:
            axes.set_ylim(*self.y_limits)
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def save(path, panels):
    """Write the panels below each other; coarser curves if the file gets too large. False if there is nothing to draw."""
    panels = [panel for panel in panels if panel.items]
    if not panels:
        return False
    points = POINTS
    while True:
        figure, all_axes = plt.subplots(len(panels), 1, figsize=(8.6, 2.3 * len(panels) + 0.2), squeeze=False)
        for panel, axes in zip(panels, all_axes[:, 0]):
            panel.draw(axes, points)
        figure.tight_layout(pad=0.6)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        plt.close(figure)
        if path.stat().st_size <= LARGEST or points < 60:
            return True
        points = int(points * 0.75)


def palette():
    """The colours of the drivers' pictures (src/post/picture/picture.c), and half of them with white for what scaling makes of the edges."""
    from PIL import Image
    fluid = np.array([(18, 33, 107), (26, 102, 173), (56, 176, 168), (173, 219, 97), (252, 237, 64)])
    gas = np.array([(230, 222, 209), (235, 204, 163), (230, 168, 112), (209, 117, 69), (158, 64, 36)])
    hues = np.concatenate([np.column_stack([np.interp(np.linspace(0, 4, n), range(5), m[:, i]) for i in range(3)]) for m, n in ((fluid, 57), (gas, 17))])
    solid = np.array([(0, 0, 0), (26, 26, 26), (140, 140, 148), (214, 214, 219), (255, 255, 255)])
    edges = (np.concatenate([hues[::4], solid]) + 255) / 2
    colours = Image.new("P", (1, 1))
    colours.putpalette([int(part) for part in np.concatenate([hues, solid, edges]).ravel()])
    return colours


def lower(image, part):
    """The lower part of a picture below its caption, without the colour bar."""
    from PIL import Image
    width, caption = round(0.89 * image.width), round(0.05 * image.height)
    below = image.crop((0, round((1 - part) * image.height), width, image.height))
    result = Image.new("RGB", (width, caption + below.height), "white")
    result.paste(image.crop((0, 0, width, caption)), (0, 0))
    result.paste(below, (0, caption))
    return result


def pictures(path, sources, part=1.0, columns=2, width=620):
    """Pictures of a driver side by side, with few colours so that the file stays small. False if none is there."""
    from PIL import Image  # comes with matplotlib
    images = [Image.open(source).convert("RGB") for source in sources if source.exists()]
    if not images:
        return False
    colours, columns = palette(), min(columns, len(images))
    if part < 1:
        images = [lower(image, part) for image in images]
    images = [image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS) for image in images]
    height, rows = max(image.height for image in images), -(-len(images) // columns)
    sheet = Image.new("RGB", (columns * width, rows * height), "white")
    for i, image in enumerate(images):
        sheet.paste(image, (i % columns * width, i // columns * height))
    sheet.quantize(palette=colours, dither=Image.Dither.NONE).save(path, optimize=True)
    return True


def draw_frame(axes, frame, dp, window, lines):
    """Particles as discs: liquid, what is about it, walls; lines over them. `window`: what is shown [m], from the floor's left end."""
    from matplotlib.collections import EllipseCollection
    (x0, y0), (x1, _) = frame.walls()
    for particles, colour, size in ((frame.x[frame.kind == 1], SOLID, 0.9), (frame.particles(1), GAS, 0.6), (frame.particles(0), WATER, 0.8)):
        if len(particles):
            axes.add_collection(EllipseCollection(size * dp, size * dp, 0, units="x", offsets=particles - (x0, y0), transOffset=axes.transData,
                                                  facecolors=colour, linewidths=0, antialiaseds=False))
    for line in lines:
        axes.plot(line[:, 0], line[:, 1], color="#c03020", linewidth=0.8)
    axes.set_xlim(-dp, x1 - x0 + dp)
    axes.set_ylim(window[0] - dp, window[1] + dp)
    axes.set_aspect("equal")


def save_picture(figure, path):
    """Write a figure as PNG of few colours, with fewer pixels if the file gets too large."""
    from io import BytesIO
    from PIL import Image
    for dpi in (130, 110, 95, 80, 65, 50):
        buffer = BytesIO()
        figure.savefig(buffer, format="png", dpi=dpi)
        Image.open(buffer).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(path, optimize=True)
        if path.stat().st_size <= LARGEST_PICTURE:
            break
    plt.close(figure)


def flow(path, rows, window):
    """Frames beside and below each other. `rows`: lists of (title, frame, dp, lines over it), frame None where there is none; `window`: heights
    shown. False if there is no frame at all."""
    first = next((frame for row in rows for _, frame, *_ in row if frame), None)
    if not first:
        return False
    (x0, _), (x1, _) = first.walls()
    columns = max(len(row) for row in rows)
    wide = 9.0 / columns
    figure, grid = plt.subplots(len(rows), columns, figsize=(9.0, len(rows) * (wide * (window[1] - window[0]) / (x1 - x0) + 0.3)), squeeze=False)
    for axes in grid.ravel():
        axes.set_axis_off()
    for r, row in enumerate(rows):
        for axes, (title, frame, dp, lines) in zip(grid[r], row):
            axes.set_title(title)
            if frame:
                draw_frame(axes, frame, dp, window, lines)
    figure.tight_layout(pad=0.6)
    save_picture(figure, path)
    return True


def maps(path, panels, label):
    """Values over place and time, one panel beside the other: (title, x, t, values[t][x], times marked by a line)."""
    if not panels:
        return False
    figure, grid = plt.subplots(1, len(panels), figsize=(4.5 * len(panels), 5.2), squeeze=False, sharey=True, layout="constrained")
    least, largest = np.nanpercentile(np.concatenate([values.ravel() for _, _, _, values, _ in panels]), (0.5, 99.5))
    for axes, (title, x, t, values, marks) in zip(grid[0], panels):
        image = axes.pcolormesh(x, t, values, vmin=least, vmax=largest, cmap="YlGnBu", shading="nearest", rasterized=True)
        for mark in marks:
            axes.axhline(mark, color="#c03020", linewidth=0.6)
        axes.set_title(title)
        axes.set_xlabel("x [m]")
        axes.set_ylabel("t [s]")
        axes.grid(False)
    figure.colorbar(image, ax=list(grid[0]), label=label)
    save_picture(figure, path)
    return True
