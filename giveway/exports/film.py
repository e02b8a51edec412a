"""The export of a run as a film: MP4 or GIF, from above, to scale.

Pillow paints the frames at twice their size, and they are halved for smoothness. MP4 is H.264,
encoded by the FFmpeg in the wheel imageio-ffmpeg (extra ``video``), which runs as a separate
process.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from giveway.config.files.naming import title
from giveway.errors import InstallationError, ResultsError
from giveway.exports.sampling import PEDESTRIAN, Sampled, Track
from giveway.figures.road import LIGHTS, UNPAINTED, bands
from giveway.figures.sight_view import SightView, polygons_of
from giveway.figures.style import BLUE, GREY, LIGHT_GREY, VERMILION
from giveway.figures.view import Box, nose_of
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose, angle_to_heading
from giveway.replays.run_folder import RunFolder
from giveway.run_data.road_marks import shown
from giveway.run_data.scene import Opaque

MP4_SIZE, GIF_SIZE = (1280, 720), (640, 360)  # Sizes [pixels]
_FINER = 2  # factor between the painted and the final size of a frame
_MARGIN = 4.0  # [m] margin around all places
_WHOLE = 110.0  # [m] largest scene shown as a whole; else the view follows the first ego
_FOLLOWED = 72.0  # [m] width of a view that follows
_LEAST = 36.0  # [m] smallest width of any view
_BODY = 0.27  # [m] radius of a pedestrian
_CAR = (4.3, 1.8)  # [m] size of a vehicle whose size is not on record
_TICK = 1.0  # [s] length of the walking direction's mark, as a time
_TRAIL = 4.0  # [s] length of the ego's trail
_SKIN = "#8A3C00"
_SHADE = 64  # opacity of shadows, of 255


class Painter:
    """Paints the frames of a run.

    Args:
        run: Results folder.
        sampled: Trajectories of the run.
        size: Size of a frame, width and height [pixels].
    """

    def __init__(self, run: RunFolder, sampled: Sampled, size: tuple[int, int]) -> None:
        self._run, self._sampled, self._size = run, sampled, size
        self._egos = [track for track in sampled.tracks if track.type == "ego"]
        whole = self._extent()
        self._follows = whole.size[0] > _WHOLE and bool(self._egos)
        self._whole = _widened(whole, size[1] / size[0])
        self._signals = run.signals
        self._large, self._small = (_font(_FINER * size[1] // parts) for parts in (24, 36))
        self._outlines = [np.array(outline) for outline in run.scene.road if len(outline) > 2]
        self._present = sampled.present
        self._sights = {
            name: view
            for name, config in run.egos.items()
            if (view := SightView.of(config, run.sights_of(name), run.scene.opaque or Opaque()))
        }

    def frames(self) -> Iterator[Image.Image]:
        """Yield all frames of the run, one after the other."""
        still = None if self._follows else self._ground(self._whole)
        for index in range(self._sampled.count):
            view = self._view(index)
            frame = self._ground(view) if still is None else still.copy()
            self._paint(frame, index, view)
            yield frame.reduce(_FINER)

    def _extent(self) -> Box:
        tracks = self._sampled.tracks
        near = [track for track in tracks if track.type == PEDESTRIAN] + self._egos
        points = [np.column_stack([track.x, track.y]) for track in near or tracks]
        return Box.around(np.concatenate(points), _MARGIN)

    def _view(self, index: int) -> Box:
        """Return the view of a frame."""
        if not self._follows:
            return self._whole
        ego = self._egos[0]
        k = min(max(index - ego.first, 0), len(ego) - 1)
        heading = np.deg2rad(90.0 - ego.angle[k])
        middle = np.array([ego.x[k], ego.y[k]])
        middle += 0.12 * _FOLLOWED * np.array([np.cos(heading), np.sin(heading)])
        return Box.centred(middle, (_FOLLOWED, _FOLLOWED * self._size[1] / self._size[0]))

    # --- the ground ---------------------------------------------------------------------------

    def _ground(self, view: Box) -> Image.Image:
        canvas = Image.new("RGB", (_FINER * self._size[0], _FINER * self._size[1]), "white")
        draw, scene = ImageDraw.Draw(canvas), self._run.scene
        for outline in self._outlines:
            if view.touches(outline):
                draw.polygon(self._pixels(outline, view), fill=LIGHT_GREY, outline="white")
        for zebra in scene.marks.zebras:
            for k, band in enumerate([*bands(zebra, whole=True), *bands(zebra)]):
                if view.touches(band):
                    draw.polygon(self._pixels(band, view), fill="white" if k else UNPAINTED)
        return canvas

    # --- the moving objects -------------------------------------------------------------------

    def _paint(self, canvas: Image.Image, index: int, view: Box) -> None:
        draw = ImageDraw.Draw(canvas)
        scale = canvas.width / view.size[0]  # pixels per metre
        self._paint_lights(draw, self._sampled.time(index), view, scale)
        self._paint_trail(draw, index, view, scale)
        here = [self._sampled.tracks[number] for number in self._present[index]]
        bodies = [
            (track, self._corners(track, index)) for track in here if track.type != PEDESTRIAN
        ]
        self._paint_shadows(canvas, index, view, bodies)
        for track, corners in bodies:
            ego = track.type == "ego"
            fill = BLUE if ego else "#B0B0B0"
            draw.polygon(self._pixels(corners, view), fill=fill, outline="#1A1A1A" if ego else GREY)
            if ego:
                draw.polygon(self._pixels(nose_of(corners), view), fill="white")
        for track in (track for track in here if track.type == PEDESTRIAN):
            k = index - track.first
            heading = np.deg2rad(90.0 - track.angle[k])
            step = _TICK * track.speed[k] * np.array([np.cos(heading), np.sin(heading)])
            centre = np.array([track.x[k], track.y[k]])
            (x, y), ahead = self._pixels(np.array([centre, centre + step]), view)
            radius = max(_BODY * scale, 3.0)
            draw.line([(x, y), ahead], fill=_SKIN, width=max(2, round(0.06 * scale)))
            bounds = (x - radius, y - radius, x + radius, y + radius)
            seen = not self._sights or any(
                sight.perceives(track.object, self._sampled.time(index))
                for sight in self._sights.values()
            )
            draw.ellipse(bounds, fill=VERMILION if seen else None, outline=_SKIN, width=2)
        self._paint_words(draw, canvas, index, scale)

    def _corners(self, track: Track, index: int) -> Array:
        """Return the corners (4, 2) [m] of a vehicle in a frame."""
        k = index - track.first
        shape = VehicleShape(*self._run.scene.body(track.object, _CAR))
        front = np.array([track.x[k], track.y[k]])
        return shape.corners(front, angle_to_heading(float(track.angle[k])))

    def _paint_shadows(
        self, canvas: Image.Image, index: int, view: Box, bodies: list[tuple[Track, Array]]
    ) -> None:
        """Darken what the first ego's cameras do not see within their fields of view."""
        own = next((track for track, _ in bodies if track.object in self._sights), None)
        if own is None:
            return
        k = index - own.first
        pose = Pose(own.x[k], own.y[k], angle_to_heading(float(own.angle[k])))
        others = [(track.object, corners) for track, corners in bodies if track is not own]
        shade = Image.new("L", canvas.size)
        draw = ImageDraw.Draw(shade)
        for polygon in polygons_of(self._sights[own.object].hidden(pose, others)):
            draw.polygon(self._pixels(np.array(polygon.exterior.coords), view), fill=_SHADE)
            for hole in polygon.interiors:
                draw.polygon(self._pixels(np.array(hole.coords), view), fill=0)
        canvas.paste("black", mask=shade)

    def _paint_lights(
        self, draw: ImageDraw.ImageDraw, time: float, view: Box, scale: float
    ) -> None:
        heads = self._run.scene.marks.heads
        if not heads:
            return
        states: dict[str, str] = {}
        if len(self._signals):
            until = self._signals[self._signals["time"] <= time + 1e-9]
            states = dict(zip(until["system"], until["state"], strict=True))
        for head in heads:
            ends = np.array(head.ends)
            if view.touches(ends):
                state = states.get(head.system, "")
                letters = [state[link] for link in head.links if 0 <= link < len(state)]
                colour = LIGHTS[shown("".join(letters))]
                draw.line(self._pixels(ends, view), fill=colour, width=max(4, round(0.4 * scale)))

    def _paint_trail(self, draw: ImageDraw.ImageDraw, index: int, view: Box, scale: float) -> None:
        back = round(_TRAIL / self._sampled.step)
        for ego in self._egos:
            k = min(index - ego.first, len(ego) - 1)
            if k < 1 or index - ego.first >= len(ego):
                continue
            way = np.column_stack([ego.x, ego.y])[max(0, k - back) : k + 1]
            line = self._pixels(way, view)
            draw.line(line, fill="#9CC4E4", width=max(4, round(0.25 * scale)), joint="curve")

    def _paint_words(
        self, draw: ImageDraw.ImageDraw, canvas: Image.Image, index: int, scale: float
    ) -> None:
        pad = canvas.height // 45
        told = f"{index * self._sampled.step:.1f} s"
        for ego in self._egos[:1]:
            k = index - ego.first
            if 0 <= k < len(ego):
                told += f"   {ego.speed[k]:.1f} m/s"
        _label(draw, (pad, pad), told, self._large)
        config = self._run.config
        about = title(config, Path(config.scenario).stem)
        _label(draw, (pad, canvas.height - pad), about, self._small, low=True)
        metres = 10.0 if scale * 10.0 < canvas.width / 4 else 5.0
        right, low = canvas.width - pad, canvas.height - pad
        left = right - metres * scale
        draw.line([(left, low), (right, low)], fill="#404040", width=max(3, canvas.height // 300))
        middle = ((left + right) / 2, low - pad / 3)
        draw.text(middle, f"{metres:g} m", fill="#404040", font=self._small, anchor="ms")

    def _pixels(self, points: Array, view: Box) -> list[tuple[float, float]]:
        width, height = _FINER * self._size[0], _FINER * self._size[1]
        x = (points[:, 0] - view.left) / view.size[0] * width
        y = (view.top - points[:, 1]) / view.size[1] * height
        return list(zip(x.tolist(), y.tolist(), strict=True))


def write_gif(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write an animated GIF that repeats.

    Returns:
        The written file, in words.
    """
    first, *others = _paletted(Painter(run, sampled, GIF_SIZE))
    first.save(
        file,
        format="GIF",
        save_all=True,
        append_images=others,
        duration=round(1000.0 * sampled.step),
        loop=0,
        optimize=False,
        disposal=1,
    )
    return _told(sampled, GIF_SIZE)


def write_mp4(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write an MP4 (H.264).

    Returns:
        The written file, in words.

    Raises:
        InstallationError: imageio-ffmpeg is not installed.
        ResultsError: FFmpeg could not encode the film.
    """
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise InstallationError(
            "MP4 needs imageio-ffmpeg; install it with: pip install 'giveway[video]', or write a "
            "GIF (--format gif)"
        ) from error
    file.touch()  # shows here that the place can be written, since FFmpeg's message would be long
    painter = Painter(run, sampled, MP4_SIZE)
    sink = imageio_ffmpeg.write_frames(
        str(file),
        MP4_SIZE,
        fps=1.0 / sampled.step,
        codec="libx264",
        quality=None,
        output_params=["-crf", "20", "-preset", "veryfast", "-movflags", "+faststart"],
        macro_block_size=2,
        ffmpeg_log_level="error",
    )
    try:
        sink.send(None)
        for frame in painter.frames():
            sink.send(frame.tobytes())
        sink.close()
    except OSError as error:
        said = " ".join(str(error).partition("FFMPEG")[0].split())[:200]
        raise ResultsError(f"{file}: FFmpeg could not encode the film ({said})") from error
    return _told(sampled, MP4_SIZE)


def _paletted(painter: Painter) -> Iterator[Image.Image]:
    """Yield the frames with 256 common colours, from the first frame and moving objects."""
    palette: Image.Image | None = None
    for frame in painter.frames():
        if palette is None:
            swatch = Image.new("RGB", (frame.width, frame.height + 40), "white")
            swatch.paste(frame, (0, 0))
            draw = ImageDraw.Draw(swatch)
            known = [BLUE, VERMILION, _SKIN, "#9CC4E4", "#B0B0B0", "#1A1A1A", *LIGHTS.values()]
            for k, colour in enumerate(known):
                draw.rectangle((40 * k, frame.height, 40 * k + 39, frame.height + 39), fill=colour)
            palette = swatch.quantize(256, method=Image.Quantize.MEDIANCUT)
        yield frame.quantize(palette=palette, dither=Image.Dither.NONE)


def _told(sampled: Sampled, size: tuple[int, int]) -> str:
    seconds = (sampled.count - 1) * sampled.step
    return f"{sampled.count} frames of {size[0]} x {size[1]} pixels, {seconds:.1f} s"


def _widened(box: Box, aspect: float) -> Box:
    """Return the smallest view of an aspect (height over width) that holds a box."""
    width, height = box.size
    width = max(width, height / aspect, _LEAST)
    middle = np.array([(box.left + box.right) / 2.0, (box.bottom + box.top) / 2.0])
    return Box.centred(middle, (width, aspect * width))


def _font(size: int) -> Any:
    file = Path(mpl.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    return ImageFont.truetype(str(file), size)


def _label(
    draw: ImageDraw.ImageDraw, place: tuple[int, int], text: str, font: Any, *, low: bool = False
) -> None:
    """Draw a line of text on a white ground."""
    anchor = "ls" if low else "la"
    x0, y0, x1, y1 = draw.textbbox(place, text, font=font, anchor=anchor)
    pad = (y1 - y0) / 4
    draw.rectangle((x0 - pad, y0 - pad, x1 + pad, y1 + pad), fill="white")
    draw.text(place, text, fill="#202020", font=font, anchor=anchor)
