"""Related work: what blending frames in the image does while the camera moves."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from paper import measures
from paper.bench import Bench
from paper.findings import Claim, Finding, Panel, Plate, Section
from paper.plots import Line, line_plot
from paper.references import ImageSpace
from paper.views import View, grey, view_of

#: Frames before the camera moves, while it moves, and after it; pixels that it moves in a frame.
STILL_FRAMES, PAN_PIXELS = 30, 6.0
POINT, ZOOM = (0.63, 0.37), 2.0
#: Frames from one that this method draws to the next: they are all alike.
OURS_INTERVAL_FRAMES = 4
#: Name of each method in plots.
IMAGE, OURS = "image space, frame upon frame", "this method, each frame by itself"


def _panned(view: View, pixels: float) -> View:
    """Return the same view moved to the side by that many pixels."""
    camera = view.camera
    way = camera.axes[0] * (pixels * 2.0 * camera.parallel_scale / view.size[1])
    position, focal_point = (np.add(end, way) for end in (camera.position, camera.focal_point))
    return replace(view, camera=replace(camera, position=position, focal_point=focal_point))


def _moving(bench: Bench) -> Finding:
    size = bench.pick((360, 300), (90, 75))
    moving, after = bench.pick((12, 24), (6, 10))
    first = view_of(bench, bench.gyre, size, zoom=ZOOM, focus=POINT)
    image = ImageSpace(first.camera, first.size, bench.gyre, blend=0.1, pixels=2.0, seed=bench.seed)
    image.frames(STILL_FRAMES)
    figures: dict[str, dict[str, list[float]]] = {
        name: {"angle": [], "coherence": []} for name in (IMAGE, OURS)
    }
    last: dict[str, Floats] = {}
    frames = list(range(-2, moving + after))
    for frame in frames:
        view = _panned(first, PAN_PIXELS * min(max(frame + 1, 0), moving))
        image.look(view.camera)
        values = image.frame()
        _note(figures[IMAGE], view, values)
        # Frames without memory: the picture of this view is all that there is.
        if frame % OURS_INTERVAL_FRAMES == 0:
            ours = view.picture().value
            _note(figures[OURS], view, ours)
        if frame == moving - 1:
            last = {IMAGE: values, OURS: view.picture().value}
    rest = _panned(first, PAN_PIXELS * moving)
    fresh = rest.picture().value
    same = float(np.nanmax(np.abs(fresh - last[OURS])))
    return _finding(figures, last, image, rest, same, frames, moving)


def _note(figures: dict[str, list[float]], view: View, values: Floats) -> None:
    streaks = view.streaks(values)
    figures["angle"].append(streaks.angle)
    figures["coherence"].append(streaks.coherence)


def _finding(
    figures: dict[str, dict[str, list[float]]],
    last: dict[str, Floats],
    image: ImageSpace,
    view: View,
    same: float,
    frames: list[int],
    moving: int,
) -> Finding:
    plot = line_plot(
        [
            Line(IMAGE, frames, figures[IMAGE]["angle"]),
            Line(
                OURS, [f for f in frames if f % OURS_INTERVAL_FRAMES == 0], figures[OURS]["angle"]
            ),
        ],
        x=f"frame; the camera moves by {PAN_PIXELS:g} pixels a frame in frames 0 to {moving - 1}",
        y="mean angle to the flow, degrees",
        caption="Angle between streaks and flow while the camera moves, and after it has stopped.",
        alt="In image space the angle rises while the camera moves and falls over some frames "
        "after; here it stays as it is.",
    )
    at_rest = image.frames(STILL_FRAMES)
    sharp = {
        "moving": measures.sharpness(last[IMAGE], view.mask),
        "at rest": measures.sharpness(at_rest, view.mask),
    }
    panels = [
        Panel(
            grey(measures.standardised(last[IMAGE])),
            "Image space: the last frame in which the camera moves.",
        ),
        Panel(grey(measures.standardised(at_rest)), f"Image space: {STILL_FRAMES} frames later."),
        Panel(grey(last[OURS]), "This method: the last frame in which the camera moves."),
    ]
    angles = figures[IMAGE]["angle"]
    numbers: dict[str, Any] = {
        "angles": {name: streaks["angle"] for name, streaks in figures.items()},
        "coherence": {name: streaks["coherence"] for name, streaks in figures.items()},
        "difference_from_a_fresh_frame": same,
        "sharpness_image_space": sharp,
        "frames_to_recover": _recovery(angles, moving + 2),
    }
    plate = Plate(panels, "A double gyre while the view slides to the right.")
    return Finding([plate, plot], numbers, _claims(numbers, figures, moving))


def _recovery(angles: list[float], stop: int) -> int:
    """Frames after the camera has stopped until nine tenths of what the angle rose are gone."""
    clear = angles[0] + 0.1 * (angles[stop - 1] - angles[0])
    for count, angle in enumerate(angles[stop:], start=1):
        if angle <= clear:
            return count
    return len(angles) - stop


def _claims(
    numbers: dict[str, Any], figures: dict[str, dict[str, list[float]]], moving: int
) -> list[Claim]:
    image, ours = figures[IMAGE]["angle"], figures[OURS]["angle"]
    return [
        Claim(
            "moving_image_space_loses_the_flow",
            "Section 1: frames that are blended in the image are spoilt while the view moves. "
            "Rise of the mean angle between streaks and flow.",
            image[moving + 1] - image[0],
            2.0,
            "at least",
            "°",
        ),
        Claim(
            "moving_image_space_clears_over_frames",
            "Section 1: after that the image clears up only over several frames: until nine tenths "
            "of the rise are gone.",
            float(numbers["frames_to_recover"]),
            3.0,
            "at least",
            "frames",
        ),
        Claim(
            "moving_no_blur_here",
            "Section 1: with this method nothing blurs while the view moves. Rise of the angle.",
            max(ours) - ours[0],
            0.5,
            "at most",
            "°",
        ),
        Claim(
            "moving_frames_are_independent",
            "Section 3.3: a frame does not depend on the one before. Difference between a frame "
            "of the motion and one drawn afresh.",
            numbers["difference_from_a_fresh_frame"],
            0.0,
            "at most",
        ),
    ]


SECTIONS = [
    Section(
        "moving",
        "While the camera moves",
        "Sections 1 and 3.3",
        "Methods that advect the last frame in the image need the same view from frame to frame. "
        "When the view moves their pictures blur, and clear up over several frames. Here no frame "
        "needs the one before.",
        "A reference of such a method, after IBFVS and ISA (paper.references.ImageSpace): the "
        "velocity is projected to the image, and each frame is the last one, carried along it, "
        "with a tenth of fresh noise. The view slides by six pixels a frame, then stops.",
        _moving,
        "The related work, beside it",
    )
]
